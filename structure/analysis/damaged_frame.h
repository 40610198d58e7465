#pragma once
// A building's frame under one combination that loses a member and gets it back. What a loss means for its panels
// (edges that no longer hold, membranes that are load alone, load that goes another way) is as in a running collapse;
// shell panels are superelements that hang on the building's nodes.
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "analysis/divided_building.h"
#include "analysis/motion/moving_frame.h"
#include "loads/frame_loads.h"
#include "topple/solver/reanalysis.h"

namespace topple::structure {

class DamagedFrame {
 public:
  /// `candidates`: members of the whole building that may be lost. Other ids here are those of the divided one, which
  /// must outlive this.
  DamagedFrame(const DividedBuilding& divided, const std::vector<MemberId>& candidates,
               const solver::AnalysisOptions& options);
  DamagedFrame(const DamagedFrame&) = delete;
  DamagedFrame& operator=(const DamagedFrame&) = delete;

  void load(const PartLoads& loads);
  /// A member of the whole building, all of its pieces.
  void lose(MemberId member);
  /// Gives back what was lost last; takes effect with the next solve().
  void restore();
  /// These are going to be lost next, one after the other: the answers of those in one piece are found together.
  void expect(std::span<const MemberId> members);
  /// Axial forces act on the members as they lie, from the next solve() on.
  void use_second_order() { second_order_ = true; }
  [[nodiscard]] const solver::ReanalysisAnswer& solve();
  /// False when the last solve() found an elastic answer, but second order does not settle there.
  [[nodiscard]] bool settled() const { return settled_; }

  [[nodiscard]] const solver::Reanalysis& analysis() const { return *analysis_; }
  /// Local, as Reanalysis has them; with second order those that hold the displaced member in balance.
  [[nodiscard]] solver::Vec12 beam_end_forces(int beam) const;
  [[nodiscard]] bool stands(MemberId piece) const { return divided_.member(piece) != lost_; }
  /// Demand of each breakable joint that holds, in order; of all others nothing is written.
  void read_demands(std::vector<Vec6>& demand, std::vector<JointId>& holding) const;
  /// Where demands come from. Of rates (by time, under loads that stay) what loads bring by themselves is no part.
  class Motion {
   public:
    virtual ~Motion() = default;
    [[nodiscard]] virtual solver::Vec12 beam_end_forces(int beam) const = 0;
    [[nodiscard]] virtual std::array<Vec6, 4> shell_corner_forces(int shell) const = 0;
    [[nodiscard]] virtual const std::vector<Vec6>& displacements() const = 0;
    bool rates = false;
  };
  void read_demands(const Motion& motion, std::vector<Vec6>& demand, std::vector<JointId>& holding) const;
  /// The loads of one case with the factor 1, on beams and nodes as panels hand them on now. Throws InputError for
  /// settlements, heat in panels and what acts on shell panels.
  [[nodiscard]] solver::LoadSet loads_of_case(LoadCaseId load_case) const;
  /// All that stands now, with its mass: what presses it down over gravity (panels' weight where they hand it to; of a
  /// part without weight its material's), and the masses given. A shell panel's lies in equal parts at its corners.
  [[nodiscard]] MovingFrame moving_frame(std::vector<solver::NodeMass> given) const;

 private:
  void write_loads();
  void write_load(NodeId node);
  [[nodiscard]] bool displace();
  [[nodiscard]] solver::Vec12 geometric_forces(int beam, const std::vector<Vec6>& displacements) const;
  void set_ground(NodeId node, bool held);
  void hang_shells();
  [[nodiscard]] std::vector<NodeId> nodes_left_bare(MemberId member) const;
  [[nodiscard]] std::array<bool, 4> edges_that_bear(PanelId shell) const;
  [[nodiscard]] std::array<Vec6, 4> edge_demands(PanelId shell, const Motion& motion) const;
  void weigh_panels(MovingFrame& moving, std::vector<double>& mass) const;

  const DividedBuilding& divided_;
  const Building& building_;
  Frame frame_;
  EdgeMembers edges_;
  PanelBearings whole_, bearings_;
  PanelSuperelements shells_;
  std::map<PanelId, std::array<double, 4>> intact_;  ///< lengths of the edges of shells
  std::optional<FrameLoads> loads_;
  std::unique_ptr<solver::Reanalysis> analysis_;
  std::vector<int> hold_node_;  ///< per node: ends of members there, and shells
  std::vector<int> ground_;     ///< per node: a support without stiffness that holds it once nothing else does; -1
  bool second_order_ = false, settled_ = true;
  std::vector<Vec6> geometric_;  ///< per node: added to the loads by second order; empty: none
  // What was lost last.
  MemberId lost_;
  PanelBearings::Changes changes_;
  std::vector<NodeId> bare_;
};

/// What is told where DamagedFrame::settled() is false.
inline constexpr const char* no_displaced_rest = "with second order there is no state of rest (it buckles)";

/// Throw InputError for what such a frame does not go with; `what` is asked for: "losses of members".
void refuse_what_is_not_built(const Building& building, const std::string& what);
void refuse_loads_that_are_not_built(const Building& building, CombinationId combination, const PartLoads& loads,
                                     const std::string& what);

}  // namespace topple::structure
