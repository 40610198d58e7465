#pragma once
// What the results of a combination tell, from the displacements and end forces that solve its equations.
#include <span>
#include <utility>
#include <vector>

#include "analysis/bearing_edges.h"
#include "analysis/equilibrium.h"
#include "analysis/loads_by_member.h"
#include "analysis/one_way_members.h"
#include "analysis/storeys.h"
#include "failure/panel_bearings.h"
#include "loads/case_loads.h"
#include "topple/structure/analysis.h"
#include "topple/structure/frame.h"

namespace topple::structure {

/// Load cases of which a combination is a sum.
struct SummedCases {
  const CaseLoadsByMember& on_members;
  const std::vector<Balance>& balances;  ///< of each case
  const Eigen::MatrixXd& factors;        ///< case, combination
};

/// Members, panels, joints, storeys, reactions and balance of combinations of one analysis. Building, frame, edges and
/// request outlive it; several threads may ask at once.
class AnswerRecovery {
 public:
  /// `brief`: without extremes, stations, the largest displacement and the meshes' errors (analyse_briefly()).
  /// `parallel`: combinations are recovered on several threads, so that members of one are not.
  AnswerRecovery(const Building& building, const Frame& frame, const EdgeMembers& edges, const AnalysisRequest& request,
                 bool brief, bool parallel);

  [[nodiscard]] CombinationResult recovered(CombinationId combination, const OneWayAnswer& answer,
                                            CombinationLoads loads) const;
  /// The same where its loads are a sum: combination k of `cases`.
  [[nodiscard]] CombinationResult recovered_sum(CombinationId combination, const OneWayAnswer& answer,
                                                const SummedCases& cases, std::size_t k) const;

 private:
  /// `loads_on(member)`: on the whole of each. Reactions are still those of the frame's supports.
  template <class LoadsOn>
  [[nodiscard]] CombinationResult gathered(const OneWayAnswer& answer, const solver::StaticSolution& solution,
                                           const PartLoads& parts, const EdgeForces& forces, LoadsOn loads_on) const;

  void hold_against_reactions(const Balance& applied, bool displaced, CombinationResult& result) const;

  /// A spring support whose far end is moved pushes its node: that is part of its reaction, not a load. Returns what
  /// takes the pushes off the loads again.
  [[nodiscard]] std::vector<solver::NodeLoad> pushes_of_supports(const PartLoads& parts,
                                                                 std::vector<Vec6>& reactions) const;

  template <class Diagram>
  void fill(MemberResult& member, double length, const Diagram& diagram) const;

  template <class Diagram>
  static void add_critical_sections(MemberResult& member, double length, const Diagram& diagram);

  template <class LoadsOn>
  [[nodiscard]] std::vector<MemberResult> members(const OneWayAnswer& answer, LoadsOn loads_on) const;

  /// Hands the diagram of member i, and the length it goes over, to `use`; sets its end forces where it is several
  /// beams.
  template <class Use>
  void with_diagram(const OneWayAnswer& answer, std::span<const solver::BeamLoad> on, std::size_t i,
                    solver::Vec12& member_end_forces, Use use) const;

  /// Mean membrane forces of a membrane panel from its corner forces (the virial theorem), panel axes.
  [[nodiscard]] std::vector<PanelResult> panels(const PartLoads& parts, const solver::StaticSolution& solution) const;

  [[nodiscard]] std::vector<Utilisation> joints(const PartLoads& parts, const EdgeForces& forces,
                                                const solver::StaticSolution& solution,
                                                const CombinationResult& result) const;

  const Building& building_;
  const Frame& frame_;
  const EdgeMembers& edges_;
  const AnalysisRequest& request_;
  bool brief_, parallel_;
  BearingEdges bearing_edges_;
  PanelBearings bearings_;
  Storeys storeys_;
  std::vector<std::pair<std::size_t, int>> breakable_ends_;  ///< member, end
};

}  // namespace topple::structure
