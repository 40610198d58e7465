#pragma once
// What a Reanalysis holds: the system as it stands, what it is to become, the factor and the answer.
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "assembly/frame_system.h"
#include "assembly/matrix_rows.h"
#include "assembly/mechanism.h"
#include "assembly/refinement.h"
#include "elements/beam_strain_forces.h"
#include "factor/factor.h"
#include "reanalysis/background_factor.h"
#include "reanalysis/base_factor.h"
#include "reanalysis/selective_solution.h"
#include "topple/solver/reanalysis.h"

namespace topple::solver {

/// Contacts act where a collision engine found them: a moment that the largest force makes by less than this share of
/// the longest beam, on a node that nothing keeps from turning, is none (FrameSystem::unbalanced_load).
inline constexpr double negligible_lever = 1e-6;

/// What a beam is to be after the next solve().
struct BeamTarget {
  std::array<Vec6, 2> end_stiffness;
  bool removed = false;
  double factor = 1;
  double density = 0;  ///< of a frame that moves
  std::vector<BeamLoad> loads;
};

struct Reanalysis::State {
  std::unique_ptr<FrameSystem> system;
  AnalysisOptions options;
  std::vector<int> order;  ///< of elimination
  std::unique_ptr<Factor> factor;
  std::unique_ptr<MatrixRows> rows;              ///< of the system's matrix; made with its order
  std::unique_ptr<BaseFactor> standing;          ///< none while there is no valid factor
  std::unique_ptr<SelectiveSolution> selective;  ///< over the base factor; made when first asked for
  RefreshRules refresh_rules;
  std::unique_ptr<BaseFactor> next;            ///< remembers the changes since the refresh was begun
  std::unique_ptr<BackgroundFactor> refresh;   ///< the factor that `next` is to serve with
  std::unique_ptr<BackgroundFactor> unwanted;  ///< its result is not needed any more
  std::unique_ptr<Factor> next_factor;         ///< what the refresh made; `next` adds later changes to it
  double next_condition = 0;                   ///< of the matrix that it was made of
  double refresh_paid = 0, refresh_due = 0;    ///< cost of answers since it was begun; cost at which it is taken
  double correction_paid = 0;                  ///< predicted cost of changes from before, since the factor was made
  double looked_at_softening = 0;              ///< at which the softest motion was looked at last
  bool needs_new_factor = false;               ///< the last change alone is more than a correction takes
  bool refresh_failed = false;                 ///< not to be tried again before there is another factor
  bool assembled = false, factor_valid = false;
  bool structure_stands = false;  ///< the structure as it is was judged, and is stable

  // Targets, and which of them differ from what the system has.
  std::vector<BeamTarget> targets;
  std::vector<int> changed_beams, changed_shells;
  std::vector<char> shell_removed;
  std::map<int, Mat24> given_stiffness;           ///< of shells, that wait for the next solve()
  std::map<int, Eigen::MatrixXd> given_to_patch;  ///< of patches
  std::map<int, Eigen::MatrixXd> given_mass;      ///< of patches, where the frame moves
  std::vector<Vec6> node_loads;
  bool node_loads_changed = false;
  std::vector<int> dropped_nodes;
  std::vector<std::pair<int, Vec6>> changed_supports;

  // The answer.
  bool answered = false;
  bool loads_alone = false;         ///< changed since the answer
  std::optional<Defect> mechanism;  ///< of the structure as prepared
  ReanalysisAnswer answer;
  double condition = 0;                         ///< of the factorised matrix
  LoadVector load;                              ///< of what stands now
  bool load_known = false;                      ///< false: it is summed up from nothing
  std::vector<int> stale_load_nodes;            ///< where it does not hold any longer
  Eigen::VectorXd solution, solved_force;       ///< scaled; empty: none to start from
  Eigen::VectorXd first_solution, first_force;  ///< with the factor just made, nothing changed since
  SolveQuality first_quality;
  std::vector<int> stale_nodes;   ///< touched since the solution was found
  std::vector<int> loaded_nodes;  ///< of beams that changed, and loaded otherwise, since then
  SelectiveEffort effort;
  std::vector<Vec6> displacements;
  mutable std::vector<Vec6> whole_displacements;  ///< of a selective answer, when asked for
  mutable bool whole_known = false;
  std::vector<Vec12> fixed_end;                         ///< per beam, local
  std::vector<Vec12> fixed_at_nodes;                    ///< per beam: the same reversed, on its nodes, global
  mutable std::vector<BeamStrainForces> strain_forces;  ///< per beam, made when first asked for
  mutable std::vector<char> strain_forces_known;
  std::vector<char> unbalanced;  ///< per beam: loaded in a loose direction
  mutable std::vector<Vec6> reactions;
  ReanalysisCounters counters;
  double operations = 0;  ///< of the last solve()
  /// Answers found beforehand: as everything stands (beam -1), and without one beam.
  std::vector<std::pair<int, Eigen::VectorXd>> expected;
  bool watched = false;           ///< the answer under way may leave out what does not matter
  bool eliminated_along = false;  ///< what it has to solve for is known, and eliminated with the changes' columns
  // Scratch of solve(): once grown, an answer asks for no memory.
  std::vector<int> touched_nodes, rows_to_change, rows_off;
  Eigen::VectorXd scaled_force, correction, improved, eliminated;

  State(FrameModel model, const AnalysisOptions& given);
  void mark(int beam);
  [[nodiscard]] bool pending() const;
  /// Each applies one kind of change to the system and adds the nodes whose stiffness it touched.
  void apply_supports(std::vector<int>& touched);
  void apply_dropped_nodes(std::vector<int>& touched);
  void apply_beams(std::vector<int>& touched);
  void apply_beam(int beam, std::vector<int>& touched);
  void apply_shells(std::vector<int>& touched);
  void apply_given_stiffness(std::vector<int>& touched);
  void remember_plate(std::size_t element);
  void rebuild();

  /// Brings matrix, factor and correction up to date; a defect when the structure does not stand.
  [[nodiscard]] std::optional<Defect> update_structure(const std::vector<int>& touched);
  /// Answers by a low-rank update. False: a new factor is cheaper, or the update cannot decide.
  [[nodiscard]] bool correct_factor(const std::vector<int>& touched, std::optional<Defect>& defect);
  [[nodiscard]] std::optional<Defect> refactorise();
  [[nodiscard]] FactorWork factor_work() const;
  /// Operations of a new factor with the estimate of its condition.
  [[nodiscard]] double factor_operations() const;
  void begin_refresh_if_due();
  void begin_refresh();
  /// x := K^-1 x (scaled equations) of the matrix as it stands, without a look at its error; refined once where the
  /// structure is_soft().
  void solve_as_it_stands(Eigen::VectorXd& x);
  /// It became so much softer than when the factor was made that its correction loses digits.
  [[nodiscard]] bool is_soft() const;
  /// An answer was found outside of solve(), `solves` times over the factor and its correction.
  void count_answer(int solves);
  /// What answers cost beyond those of a new factor is borne until it comes to as much as that (to rent or to buy). To
  /// be called between answers of a structure that does not change. A defect when it does not stand.
  [[nodiscard]] std::optional<Defect> renew_factor();
  /// Replaces the factor by the one made in the background. False: there is none.
  [[nodiscard]] bool take_refreshed();
  void go_on_with_refresh();
  [[nodiscard]] bool switch_now();
  void switch_factors();
  void drop_refresh();
  template <class Tell>
  void tell_standing(const Tell& tell) {
    if (standing) tell(*standing);
    if (next) tell(*next);
  }
  void update_load();
  void sum_up_load();
  void sum_up_load_at(int node);
  /// False when refinement does not reach rounding level.
  [[nodiscard]] bool solve_loads();
  /// Returns how often the factor was gone through.
  int refine(const Eigen::VectorXd& force);
  /// Starts from the answer that was found beforehand for what stands now. False: there is none.
  [[nodiscard]] bool take_expected(const Eigen::VectorXd& force);
  void expect_losses(std::span<const int> beams);
  [[nodiscard]] BaseFactor::Loss residual_without(int beam);
  void improve(const Eigen::VectorXd& force, bool first);
  void solve_for_rest(bool first);
  void find_changed_rows(const Eigen::VectorXd& force);
  /// Carries the plan out, and eliminates the residual of the last answer with it where that is possible.
  void update_correction(bool adds);
  /// Finds the residual of the last answer. False: it is not known at a part of the cost.
  [[nodiscard]] bool know_residual();
  void add_rows_of(const std::vector<int>& nodes);
  /// Brings displacements up to date where the watch needs it. False: a full answer is needed.
  [[nodiscard]] bool answer_in_part(UseWatch& watch);
  void tell_effort();
  /// Displacements everywhere, whatever the answer under way has left out.
  [[nodiscard]] const std::vector<Vec6>& whole() const;
  void find_whole() const;
  /// Makes a selective answer whole.
  void complete(UseWatch* watch);
  void bring_up_to_date(UseWatch* watch);
  void read_all_uses(UseWatch& watch);
  [[nodiscard]] const ReanalysisAnswer& solve(UseWatch* watch);
  void find_answer(UseWatch* watch);
  void take_changes(UseWatch* watch);
  void apply_changes();
  void give_up(const Defect& defect);
  [[nodiscard]] double current_condition() const;
  [[nodiscard]] const BeamStrainForces& strain_forces_of(std::size_t beam) const;
  [[nodiscard]] Vec12 end_forces(std::size_t beam, const std::vector<Vec6>& displacements, const Vec12& fixed) const;
  [[nodiscard]] LinearSolve linear_solve() const;
  void scale_force(const Eigen::VectorXd& force, Eigen::VectorXd& result) const;
  /// The force that loads make, of a structure that stands; throws Instability.
  [[nodiscard]] LoadVector force_on_standing(const LoadSet& loads) const;
  /// Answer to a force that is zero in most equations; refined to response_error.
  [[nodiscard]] Eigen::VectorXd solve_sparse(const Eigen::VectorXd& force, double& backward_error) const;
  /// Refines x until its error is within the limit.
  [[nodiscard]] Eigen::VectorXd refine_to(double limit, const Eigen::VectorXd& scaled, Eigen::VectorXd x,
                                          double& error) const;
  /// The same for several forces, a column each, the factor gone through once for all of them; and on elimination paths
  /// (BaseFactor::solve_on_paths()), not refined.
  [[nodiscard]] Eigen::MatrixXd solve_sparse(const Eigen::MatrixXd& force, std::vector<double>& backward_error) const;
  [[nodiscard]] Eigen::MatrixXd solve_on_paths(const Eigen::MatrixXd& force, std::span<const int> nodes,
                                               std::vector<char>& known) const;
  [[nodiscard]] std::vector<int> scale_columns(const Eigen::MatrixXd& force, Eigen::MatrixXd& scaled) const;
  [[nodiscard]] Eigen::MatrixXd forces_on_standing(std::span<const LoadSet> loads, std::vector<LoadVector>& own) const;
  [[nodiscard]] std::size_t checked_beam(int beam) const;
  [[nodiscard]] std::size_t checked_shell(int shell) const;
  [[nodiscard]] std::size_t checked_patch(int patch) const;
  void set_shell_removed(int shell, bool removed);
};

}  // namespace topple::solver
