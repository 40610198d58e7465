#pragma once
// What a Reanalysis holds: the system as it stands, what it is to become, the factor and the answer.
#include <iosfwd>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "assembly/frame_recovery.h"
#include "assembly/frame_system.h"
#include "reanalysis/carried_solution.h"
#include "reanalysis/changing_load.h"
#include "reanalysis/factor_refresh.h"
#include "reanalysis/kept_strain_forces.h"
#include "reanalysis/reanalysis_work.h"
#include "reanalysis/requested_changes.h"
#include "reanalysis/selective_solution.h"
#include "reanalysis/serving_factor.h"
#include "topple/solver/reanalysis.h"

namespace topple::solver {

/// Contacts act where a collision engine found them: a moment that the largest force makes by less than this share of
/// the longest beam, on a node that nothing keeps from turning, is none (FrameSystem::unbalanced_load).
inline constexpr double negligible_lever = 1e-6;

struct Reanalysis::State {
  std::unique_ptr<FrameSystem> system;
  AnalysisOptions options;
  RequestedChanges changes;
  ChangingLoad load;
  KeptStrainForces strain_forces;
  std::optional<ServingFactor> serving;  ///< over this system: another one begins anew
  FactorRefresh refresh;
  CarriedSolution solution;
  std::unique_ptr<SelectiveSolution> selective;  ///< over the base factor; made when first asked for
  bool assembled = false;
  bool structure_stands = false;  ///< the structure as it is was judged, and is stable

  // The answer.
  bool answered = false;
  std::optional<Defect> mechanism;  ///< of the structure as prepared
  ReanalysisAnswer answer;
  SelectiveEffort effort;
  bool watched = false;                           ///< the answer under way may leave out what does not matter
  mutable std::vector<Vec6> whole_displacements;  ///< of a selective answer, when asked for
  mutable bool whole_known = false;
  mutable std::vector<Vec6> reactions;  ///< per support; empty: not asked for yet
  ReanalysisWork work;
  std::vector<int> touched_nodes;  ///< by the changes under way: once grown, an answer asks for no memory
  bool factor_when_asked = false;  ///< the factor takes changes over when it is next asked, those since then together
  bool factor_lags = false;        ///< it has some to take over

  State(FrameModel model, const AnalysisOptions& given);
  [[nodiscard]] bool pending() const { return !answered || !changes.none() || !load.known(); }

  // reanalysis_changes.cpp
  void apply_changes();
  /// Each applies one kind of change to the system and adds the nodes whose stiffness it touched.
  void apply_supports(std::vector<int>& touched);
  void apply_dropped_nodes(std::vector<int>& touched);
  void apply_beams(std::vector<int>& touched);
  void apply_beam(int beam, std::vector<int>& touched);
  void apply_shells(std::vector<int>& touched);
  void apply_given_stiffness(std::vector<int>& touched);
  void remember_plate(std::size_t element);
  void rebuild();
  /// One of the same structure with its equations numbered as the model has it now takes the place of the system; what
  /// refers to that must be gone.
  void renumber(FrameModel model);
  template <class Report>
  void report_factors(const Report& report) {
    if (serving->base() != nullptr) report(serving->base()->changes());
    if (refresh.base() != nullptr) report(refresh.base()->changes());
  }

  // reanalysis_strategy.cpp
  /// Brings matrix, factor and correction up to date; a defect when the structure does not stand.
  [[nodiscard]] std::optional<Defect> update_structure(const std::vector<int>& touched);
  [[nodiscard]] std::optional<Defect> update_factor(bool changed);
  /// With factor_when_asked: the factor is that of the matrix as it stands. Throws Instability.
  void catch_up();
  enum class Correction {
    made,
    not_made,  ///< a new factor is cheaper, or the correction cannot decide
    beyond     ///< the same, and what changed last is alone more than a correction takes
  };
  /// Answers by a low-rank update.
  [[nodiscard]] Correction correct_factor(bool changed, std::optional<Defect>& defect);
  [[nodiscard]] std::optional<Defect> refactorise();

  // reanalysis_refresh.cpp
  void begin_refresh_if_due();
  void begin_refresh();
  void go_on_with_refresh();
  [[nodiscard]] bool switch_now();
  void switch_factors();
  /// What answers cost beyond those of a new factor is borne until it comes to as much as that (to rent or to buy). To
  /// be called between answers of a structure that does not change. A defect when it does not stand.
  [[nodiscard]] std::optional<Defect> renew_factor();
  /// x := K^-1 x (scaled equations) of the matrix as it stands, as ServingFactor::solve() has it.
  void solve_as_it_stands(Eigen::VectorXd& x) {
    catch_up();
    refresh.pay(serving->solve(x));
  }
  /// F' K^-1 G of the matrix as it stands (scaled equations); G is zero wherever F is. Only what joins their rows in
  /// the factor is gone through.
  [[nodiscard]] Eigen::MatrixXd answers_between(const Eigen::MatrixXd& F, const Eigen::MatrixXd& G);
  /// An answer was found outside of solve(), `solves` times over the factor and its correction.
  void count_answer(int solves) { refresh.pay(serving->count_answer(solves)); }

  // reanalysis_solve.cpp
  [[nodiscard]] const ReanalysisAnswer& solve(UtilisationWatch* watch);
  void apply_changes(UtilisationWatch* watch);
  void find_answer(UtilisationWatch* watch);
  /// False when refinement does not reach rounding level.
  [[nodiscard]] bool solve_loads();
  void give_up(const Defect& defect);
  [[nodiscard]] bool stands() const { return answer.stable && structure_stands; }

  // reanalysis_losses.cpp
  void expect_losses(std::span<const int> beams);
  [[nodiscard]] BaseFactor::Loss residual_without(int beam);

  // reanalysis_selective.cpp
  void begin_selective();
  /// Brings displacements up to date where the watch needs it. False: a full answer is needed.
  [[nodiscard]] bool answer_in_part(UtilisationWatch& watch);
  void report_effort();
  /// Displacements everywhere, whatever the answer under way has left out.
  [[nodiscard]] const std::vector<Vec6>& whole() const;
  void find_whole() const;
  /// Makes a selective answer whole.
  void complete(UtilisationWatch* watch);
  void read_all_utilisations(UtilisationWatch& watch);

  // reanalysis_archive.cpp
  void save_to(std::ostream& to) const;
  void load_from(std::istream& from);

  // reanalysis.cpp
  [[nodiscard]] Vec12 end_forces(std::size_t beam, const std::vector<Vec6>& displacements, const Vec12& fixed) const;
  /// Per support, from what beams and shells do to their nodes: end_forces_of(beam), corner_forces_of(shell).
  template <class OfBeams, class OfShells>
  [[nodiscard]] std::vector<Vec6> reactions_of(const std::vector<Vec6>& displacements, const OfBeams& end_forces_of,
                                               const OfShells& corner_forces_of) const {
    std::vector<Vec12> ends;
    for (std::size_t i = 0; i < system->model.beams.size(); ++i) ends.push_back(end_forces_of(static_cast<int>(i)));
    std::vector<std::array<Vec6, 4>> corners;
    for (std::size_t i = 0; i < system->model.shells.size(); ++i)
      corners.push_back(corner_forces_of(static_cast<int>(i)));
    return support_reactions(*system, displacements, ends, corners, load.on_nodes());
  }
  /// The forces that loads make, a column each, of a structure that stands; throws Instability.
  [[nodiscard]] Eigen::MatrixXd forces_on_standing(std::span<const LoadSet> loads, std::vector<LoadVector>& own) const;
};

}  // namespace topple::solver
