#include "reanalysis/carried_solution.h"

#include <algorithm>
#include <utility>

#include "assembly/scaled_equations.h"

namespace topple::solver {
namespace {

/// A solution found beforehand that is farther off than this (backward error) belongs to another state.
constexpr double belongs = 1e-8;

}  // namespace

void CarriedSolution::rest(const FrameSystem& system, int node) {
  const auto& first = system.dofs().first_equation;
  for (int e = first[static_cast<std::size_t>(node)]; e < first[static_cast<std::size_t>(node) + 1]; ++e)
    if (solution_.size() > e) solution_(e) = 0;
}

void CarriedSolution::forget() {
  solution_.resize(0);
  first_.resize(0);
}

void CarriedSolution::add_rows_of(const FrameSystem& system, std::span<const int> nodes) {
  const auto& first = system.dofs().first_equation;
  const auto add_vertex = [&](std::size_t v) {
    for (int e = first[v]; e < first[v + 1]; ++e) rows_to_change_.push_back(e);
  };
  for (const int node : nodes) {
    add_vertex(static_cast<std::size_t>(node));
    const int d = system.dofs().diaphragm_of_node[static_cast<std::size_t>(node)];
    if (d >= 0) add_vertex(system.model.nodes.size() + static_cast<std::size_t>(d));
  }
}

void CarriedSolution::sort_rows() {
  std::sort(rows_to_change_.begin(), rows_to_change_.end());
  rows_to_change_.erase(std::unique(rows_to_change_.begin(), rows_to_change_.end()), rows_to_change_.end());
}

/// Rows in which the solution does not fit any longer; none when they are too many to tell apart.
void CarriedSolution::find_changed_rows(const FrameSystem& system) {
  const Eigen::VectorXd& now = right_hand_side_;
  rows_to_change_.clear();
  const std::size_t most = static_cast<std::size_t>(now.size()) / 4;
  add_rows_of(system, stale_nodes_);
  for (Eigen::Index e = 0; e < now.size() && rows_to_change_.size() <= most; ++e)
    if (now(e) != solved_(e)) rows_to_change_.push_back(static_cast<int>(e));
  if (rows_to_change_.size() > most) rows_to_change_.clear();
  sort_rows();
}

/// Where the solution does not fit what stands now, and by how much. False: it is better found later.
bool CarriedSolution::update_residual(ServingFactor& factor, const Eigen::VectorXd& force, SelectiveSolution* selective,
                                      bool watched) {
  const FrameSystem& system = factor.system();
  if (!is_of(system) || !expected_.empty()) return false;
  const bool partial = selective != nullptr && selective->partial();
  if (partial && !watched) return false;  // the answer is made whole first
  scale_force(system, force, right_hand_side_);
  find_changed_rows(system);
  if (rows_to_change_.empty()) return false;
  if (selective != nullptr) {
    add_rows_of(system, loaded_nodes_);
    sort_rows();
  }
  if (partial) (void)selective->begin(rows_to_change_, answer());
  factor.rows().residual(system.matrix(), right_hand_side_, solution_, rows_to_change_, correction_);
  return true;
}

void CarriedSolution::update_correction(ServingFactor& factor, bool adds, const Eigen::VectorXd& force,
                                        SelectiveSolution* selective, bool watched) {
  eliminated_along_ = adds && update_residual(factor, force, selective, watched);
  if (eliminated_along_) {
    factor.base()->update(rows_to_change_, correction_);
  } else {
    factor.base()->update();
  }
}

/// Solves for the residual in `correction_`. When few rows are what refinement is for, for these alone: their
/// elimination paths are a part of the factor.
void CarriedSolution::solve_for_rest(ServingFactor& factor, bool first) {
  constexpr double share_of_limit = 0.1;
  if (!first) factor.rows().find_rows_above(share_of_limit * backward_error_limit, correction_, rows_off_);
  if (first || rows_off_.size() > static_cast<std::size_t>(correction_.size()) / 16) {
    factor.base()->solve(correction_);
    return;
  }
  improved_.setZero(correction_.size());
  for (const int row : rows_off_) improved_(row) = correction_(row);
  correction_.swap(improved_);
  factor.base()->solve(correction_, &rows_off_);
}

/// Solves for the residual in `correction_` and adds it, again and again. On the `first` step there is no error known
/// yet, and the residual is that of rows_to_change_ alone when there are any.
void CarriedSolution::improve(ServingFactor& factor, const Eigen::VectorXd& right_hand_side, bool first,
                              SolveQuality& quality) {
  for (int step = 0; step <= most_refinement_steps; ++step) {
    if (first && std::exchange(eliminated_along_, false)) {
      factor.base()->solve_along(correction_);
    } else if (first && !rows_to_change_.empty()) {
      factor.base()->solve(correction_, &rows_to_change_);
    } else {
      solve_for_rest(factor, first);
    }
    improved_ = solution_ + correction_;
    const double error = factor.rows().residual(factor.system().matrix(), right_hand_side, improved_, correction_);
    const bool go_on = first || error <= worthwhile_refinement * quality.backward_error;
    if (first || error < quality.backward_error) {
      solution_.swap(improved_);
      quality.backward_error = error;
      if (!first) ++quality.refinements;
    }
    first = false;
    if (!go_on || quality.backward_error <= backward_error_limit) break;
  }
}

/// From the last solution on. Returns how often the factor was gone through.
int CarriedSolution::refine(ServingFactor& factor, SolveQuality& quality) {
  if (adopt_expected(factor, quality)) return quality.refinements;
  const FrameSystem& system = factor.system();
  if (!is_of(system)) {
    solution_ = Eigen::VectorXd::Zero(right_hand_side_.size());
    correction_ = right_hand_side_;
    rows_to_change_.clear();
  } else if (!eliminated_along_) {
    find_changed_rows(system);
    if (rows_to_change_.empty()) {
      (void)factor.rows().residual(system.matrix(), right_hand_side_, solution_, correction_);
    } else {
      factor.rows().residual(system.matrix(), right_hand_side_, solution_, rows_to_change_, correction_);
    }
  }
  improve(factor, right_hand_side_, true, quality);
  return 1 + quality.refinements;
}

/// For what stands now.
void CarriedSolution::found() {
  solved_ = right_hand_side_;
  stale_nodes_.clear();
  loaded_nodes_.clear();
}

bool CarriedSolution::solve(ServingFactor& factor, const Eigen::VectorXd& force, SolveQuality& quality,
                            ReanalysisWork& work) {
  const FrameSystem& system = factor.system();
  const Eigen::Index n = system.dofs().equations;
  scale_force(system, force, right_hand_side_);
  if (n == 0) {
    quality = {};
    quality.converged = true;
    system.node_displacements_of_scaled(right_hand_side_, displacements_);
    return true;
  }
  const BaseFactor* base = factor.base();
  const bool as_factorised = base != nullptr && !base->changed();
  if ((right_hand_side_.array() == 0).all()) {
    solution_ = right_hand_side_;
    quality = {};
  } else if (as_factorised && first_.size() == n && first_solved_ == right_hand_side_) {
    solution_ = first_;  // back to where the factor was made: the very same answer
    quality = first_quality_;
  } else if (base == nullptr) {
    const RefinedSolution refined = solve_refined(system.matrix(), factor.linear_solve(), right_hand_side_);
    solution_ = refined.x.col(0);
    quality = refined.quality[0];
  } else {
    const bool first = as_factorised && first_.size() != n;
    if (first) solution_.resize(0);  // a new factor starts anew
    const double passes = refine(factor, quality);
    work.operations += passes * (base->solve_operations() + 8.0 * static_cast<double>(system.matrix().row.size()));
    if (first) {
      first_ = solution_;
      first_solved_ = right_hand_side_;
    }
  }
  found();
  quality.converged = quality.backward_error <= backward_error_limit;
  quality.condition = factor.condition();
  quality.error_bound = forward_error_bound(quality.condition, quality.backward_error);
  if (as_factorised && first_solved_.size() == n && first_solved_ == right_hand_side_) first_quality_ = quality;
  system.node_displacements_of_scaled(solution_, displacements_);
  return as_factorised || base == nullptr || quality.backward_error <= acceptable_error;
}

bool CarriedSolution::solve_in_part(ServingFactor& factor, const Eigen::VectorXd& force, SelectiveSolution& selective,
                                    UtilisationWatch& watch, SolveQuality& quality) {
  const FrameSystem& system = factor.system();
  const Eigen::Index n = system.dofs().equations;
  BaseFactor& base = *factor.base();
  if (n == 0 || !is_of(system)) return false;
  if (!base.changed() && first_.size() != n) return false;
  scale_force(system, force, right_hand_side_);
  if ((right_hand_side_.array() == 0).all() || (!base.changed() && first_solved_ == right_hand_side_)) return false;
  if (std::exchange(eliminated_along_, false)) {
    (void)selective.begin(rows_to_change_, answer());
    base.forward_along(eliminated_);
  } else {
    find_changed_rows(system);
    if (rows_to_change_.empty()) return false;
    add_rows_of(system, loaded_nodes_);
    sort_rows();
    const std::vector<char>& paths = selective.begin(rows_to_change_, answer());
    factor.rows().residual(system.matrix(), right_hand_side_, solution_, rows_to_change_, correction_);
    base.forward(correction_, paths, eliminated_);
  }
  selective.advance(rows_to_change_, correction_, eliminated_, watch, answer());
  found();
  quality.backward_error = factor.rows().error(system.matrix(), right_hand_side_, solution_, rows_to_change_);
  if (!(quality.backward_error <= acceptable_error)) return false;
  quality.converged = quality.backward_error <= backward_error_limit;
  quality.condition = factor.condition();
  quality.error_bound = forward_error_bound(quality.condition, quality.backward_error);
  return true;
}

void CarriedSolution::refine_whole(ServingFactor& factor, SolveQuality& quality, ReanalysisWork& work) {
  const FrameSystem& system = factor.system();
  quality.backward_error = factor.rows().residual(system.matrix(), solved_, solution_, correction_);
  work.operations += factor.base()->solve_operations() / 2;
  if (!(quality.backward_error <= backward_error_limit)) {
    improve(factor, solved_, false, quality);
    system.node_displacements_of_scaled(solution_, displacements_);
  }
  quality.converged = quality.backward_error <= backward_error_limit;
  quality.error_bound = forward_error_bound(quality.condition, quality.backward_error);
}

BaseFactor::Loss CarriedSolution::loss_of(int beam, ServingFactor& factor, const Eigen::VectorXd& force,
                                          std::span<const int> nodes) {
  const FrameSystem& system = factor.system();
  BaseFactor::Loss loss{beam, {}, {}};
  scale_force(system, force, right_hand_side_);
  rows_to_change_.clear();
  add_rows_of(system, nodes);
  sort_rows();
  factor.rows().residual(system.matrix(), right_hand_side_, solution_, rows_to_change_, correction_);
  loss.rows = rows_to_change_;
  loss.residual.resize(std::ssize(rows_to_change_));
  for (std::size_t i = 0; i < rows_to_change_.size(); ++i)
    loss.residual(static_cast<Eigen::Index>(i)) = correction_(rows_to_change_[i]);
  return loss;
}

void CarriedSolution::expect(ServingFactor& factor, std::span<const BaseFactor::Loss> losses, ReanalysisWork& work) {
  const Eigen::MatrixXd changes = factor.base()->solve_without(losses);
  work.operations += factor.base()->solve_operations() * static_cast<double>(losses.size());
  expected_.emplace_back(-1, solution_);
  for (std::size_t j = 0; j < losses.size(); ++j)
    expected_.emplace_back(losses[j].beam, solution_ + changes.col(static_cast<Eigen::Index>(j)));
}

/// Starts from the solution that was found beforehand for what stands now. False: there is none.
bool CarriedSolution::adopt_expected(ServingFactor& factor, SolveQuality& quality) {
  if (expected_.empty() || expected_.front().second.size() != right_hand_side_.size()) return false;
  const FrameSystem& system = factor.system();
  std::size_t place = 0;
  for (std::size_t i = 1; i < expected_.size(); ++i)
    if (system.beam_stands[static_cast<std::size_t>(expected_[i].first)] == 0) place = i;
  improved_ = expected_[place].second;
  const double error = factor.rows().residual(system.matrix(), right_hand_side_, improved_, correction_);
  if (!(error <= belongs)) {
    expected_.erase(expected_.begin() + static_cast<std::ptrdiff_t>(place),
                    place == 0 ? expected_.end() : expected_.begin() + static_cast<std::ptrdiff_t>(place) + 1);
    return false;
  }
  solution_.swap(improved_);
  quality.backward_error = error;
  if (error > backward_error_limit) improve(factor, right_hand_side_, false, quality);
  return true;
}

}  // namespace topple::solver
