// Beams that will be lost one at a time: the answers of many, found together.
#include <algorithm>

#include "reanalysis/reanalysis_state.h"

namespace topple::solver {
namespace {

/// An expected answer farther off than this (backward error) belongs to another state.
constexpr double belongs = 1e-8;

}  // namespace

void Reanalysis::expect_losses(std::span<const int> beams) {
  for (const int beam : beams) (void)state_->checked_beam(beam);
  state_->expect_losses(beams);
}

/// What the present answer leaves over when the beam is gone.
BaseFactor::Loss Reanalysis::State::residual_without(int beam) {
  BaseFactor::Loss loss{beam, {}, {}};
  const auto change = [&](bool removed) {
    targets[static_cast<std::size_t>(beam)].removed = removed;
    mark(beam);
    apply_changes();
    system->reassemble(touched_nodes);
  };
  change(true);
  scale_force(load.force, scaled_force);
  rows_to_change.clear();
  add_rows_of({touched_nodes.begin(), touched_nodes.end()});
  std::sort(rows_to_change.begin(), rows_to_change.end());
  rows_to_change.erase(std::unique(rows_to_change.begin(), rows_to_change.end()), rows_to_change.end());
  rows->residual(system->matrix(), scaled_force, solution, rows_to_change, correction);
  loss.rows = rows_to_change;
  loss.residual.resize(std::ssize(rows_to_change));
  for (std::size_t i = 0; i < rows_to_change.size(); ++i)
    loss.residual(static_cast<Eigen::Index>(i)) = correction(rows_to_change[i]);
  change(false);
  return loss;
}

void Reanalysis::State::expect_losses(std::span<const int> beams) {
  (void)solve(nullptr);
  expected.clear();
  if (!answer.stable || !structure_stands || !standing || standing->changed()) return;
  if (solution.size() != system->dofs().equations) return;
  std::vector<BaseFactor::Loss> losses;
  for (const int beam : beams)
    if (system->beam_stands[static_cast<std::size_t>(beam)] != 0) losses.push_back(residual_without(beam));
  (void)standing->plan();  // takes note that all stand again
  standing->update();
  if (standing->changed()) return;
  const Eigen::MatrixXd changes = standing->solve_without(losses);
  operations += standing->solve_operations() * static_cast<double>(losses.size());
  expected.emplace_back(-1, solution);
  for (std::size_t j = 0; j < losses.size(); ++j)
    expected.emplace_back(losses[j].beam, solution + changes.col(static_cast<Eigen::Index>(j)));
}

bool Reanalysis::State::take_expected(const Eigen::VectorXd& force) {
  if (expected.empty() || expected.front().second.size() != force.size()) return false;
  std::size_t place = 0;
  for (std::size_t i = 1; i < expected.size(); ++i)
    if (system->beam_stands[static_cast<std::size_t>(expected[i].first)] == 0) place = i;
  improved = expected[place].second;
  const double error = rows->residual(system->matrix(), force, improved, correction);
  if (!(error <= belongs)) {
    expected.erase(expected.begin() + static_cast<std::ptrdiff_t>(place),
                   place == 0 ? expected.end() : expected.begin() + static_cast<std::ptrdiff_t>(place) + 1);
    return false;
  }
  solution.swap(improved);
  answer.quality.backward_error = error;
  if (error > backward_error_limit) improve(force, false);
  return true;
}

}  // namespace topple::solver
