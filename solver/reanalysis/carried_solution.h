#pragma once
// The solution, carried from one answer to the next: what does not fit any longer is solved for and added, until the
// error is at rounding level. Solutions and right-hand sides are in the scaled equations; forces are not scaled.
#include <Eigen/Core>
#include <span>
#include <utility>
#include <vector>

#include "reanalysis/base_factor.h"
#include "reanalysis/reanalysis_work.h"
#include "reanalysis/selective_solution.h"
#include "reanalysis/serving_factor.h"
#include "topple/solver/static_analysis.h"

namespace topple::solver {

/// An answer over a correction, or a part of one, that is left with a larger backward error is found again: over a new
/// factor, or in full.
inline constexpr double acceptable_error = 1e-13;

class CarriedSolution {
 public:
  /// There is none.
  explicit CarriedSolution(std::size_t nodes) : displacements_(nodes, Vec6::Zero()) {}

  // What comes between two answers.
  /// The stiffness at these nodes changed.
  void touch(std::span<const int> nodes) { stale_nodes_.insert(stale_nodes_.end(), nodes.begin(), nodes.end()); }
  /// The beams at these nodes changed, and are loaded otherwise.
  void touch_loaded(std::span<const int> nodes) {
    loaded_nodes_.insert(loaded_nodes_.end(), nodes.begin(), nodes.end());
  }
  /// The node leaves: corrections leave it alone from now on, and start from a solution that has it at rest.
  void rest(const FrameSystem& system, int node);
  /// Another factor serves.
  void forget_first() { first_.resize(0); }
  /// The equations are others.
  void forget();
  /// Brings the correction up to date. `adds`: with the columns of new places the residual of the solution is
  /// eliminated, where it is known beforehand. `watched`: the answer may be one in part, by `selective` (may be null).
  void update_correction(ServingFactor& factor, bool adds, const Eigen::VectorXd& force, SelectiveSolution* selective,
                         bool watched);
  /// What was eliminated along with the correction is of no use.
  void forget_elimination() { eliminated_along_ = false; }

  /// The answer to a force, over whatever factor there is. False: refinement does not reach rounding level.
  [[nodiscard]] bool solve(ServingFactor& factor, const Eigen::VectorXd& force, SolveQuality& quality,
                           ReanalysisWork& work);
  /// The same where the watch's uses may matter. False: a full answer is needed.
  [[nodiscard]] bool solve_in_part(ServingFactor& factor, const Eigen::VectorXd& force, SelectiveSolution& selective,
                                   UtilisationWatch& watch, SolveQuality& quality);
  /// A solution in part was made whole: brings it to the error of a full one.
  void refine_whole(ServingFactor& factor, SolveQuality& quality, ReanalysisWork& work);

  // Solutions found beforehand, for beams that will be lost one at a time.
  void expect_nothing() { expected_.clear(); }
  /// What the solution leaves over at these nodes, now that the beam is gone.
  [[nodiscard]] BaseFactor::Loss loss_of(int beam, ServingFactor& factor, const Eigen::VectorXd& force,
                                         std::span<const int> nodes);
  /// As everything stands, and without each of these beams.
  void expect(ServingFactor& factor, std::span<const BaseFactor::Loss> losses, ReanalysisWork& work);

  /// There is one of this system's equations.
  [[nodiscard]] bool is_of(const FrameSystem& system) const { return solution_.size() == system.dofs().equations; }
  /// Nothing changed since it was found but loads.
  [[nodiscard]] bool fits_structure() const { return stale_nodes_.empty(); }
  [[nodiscard]] const Eigen::VectorXd& vector() const { return solution_; }
  /// The right-hand side that it was found for.
  [[nodiscard]] const Eigen::VectorXd& right_hand_side() const { return solved_; }
  /// Per node, global axes.
  [[nodiscard]] const std::vector<Vec6>& displacements() const { return displacements_; }
  [[nodiscard]] SelectiveSolution::Answer answer() { return {solution_, displacements_}; }

  template <class Archive>
  void serialize(Archive& archive) {
    // What was eliminated along with a correction, and all that follows it, is of one answer alone.
    auto& [solution, solved, displacements, first, first_solved, first_quality, stale_nodes, loaded_nodes, expected,
           eliminated_along, right_hand_side, correction, improved, eliminated, rows_to_change, rows_off] = *this;
    if constexpr (Archive::is_loading::value) eliminated_along = false;
    archive(solution, solved, displacements, first, first_solved, first_quality, stale_nodes, loaded_nodes, expected);
  }

 private:
  void find_changed_rows(const FrameSystem& system);
  void add_rows_of(const FrameSystem& system, std::span<const int> nodes);
  void sort_rows();
  [[nodiscard]] bool update_residual(ServingFactor& factor, const Eigen::VectorXd& force, SelectiveSolution* selective,
                                     bool watched);
  [[nodiscard]] int refine(ServingFactor& factor, SolveQuality& quality);
  [[nodiscard]] bool adopt_expected(ServingFactor& factor, SolveQuality& quality);
  void improve(ServingFactor& factor, const Eigen::VectorXd& right_hand_side, bool first, SolveQuality& quality);
  void solve_for_rest(ServingFactor& factor, bool first);
  void found();

  Eigen::VectorXd solution_, solved_;  ///< solution_ is empty when there is none to start from
  std::vector<Vec6> displacements_;
  Eigen::VectorXd first_, first_solved_;  ///< with the factor just made, nothing changed since
  SolveQuality first_quality_;
  std::vector<int> stale_nodes_, loaded_nodes_;            ///< touched since the solution was found
  std::vector<std::pair<int, Eigen::VectorXd>> expected_;  ///< as everything stands (beam -1), and without one beam
  bool eliminated_along_ = false;  ///< what is to be solved for is known, and was eliminated with the changes' columns
  // Of the answer under way: once grown, it asks for no memory.
  Eigen::VectorXd right_hand_side_, correction_, improved_, eliminated_;
  std::vector<int> rows_to_change_, rows_off_;
};

}  // namespace topple::solver
