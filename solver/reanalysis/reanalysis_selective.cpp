// Answers selective to where they may matter, and what makes them whole again.
#include <algorithm>
#include <stdexcept>
#include <utility>

#include "reanalysis/reanalysis_state.h"

namespace topple::solver {
namespace {

/// A selective answer whose changed rows are left with more than this is found again in full, and refined.
constexpr double acceptable_error = 1e-13;

}  // namespace

void Reanalysis::State::read_all_uses(UseWatch& watch) {
  if (!standing) return;
  if (!selective)
    selective = std::make_unique<SelectiveSolution>(
        *system, standing->triangles(),
        [this](int beam) -> const BeamStrainForces& { return strain_forces_of(static_cast<std::size_t>(beam)); });
  if (selective->uses_known()) return;
  complete(nullptr);
  selective->read_all(watch);
}

bool Reanalysis::State::answer_in_part(UseWatch& watch) {
  const Eigen::Index n = system->dofs().equations;
  if (!standing || !selective || !selective->uses_known() || n == 0 || solution.size() != n) return false;
  if (!standing->changed() && first_solution.size() != n) return false;
  scale_force(load.force, scaled_force);
  if ((scaled_force.array() == 0).all() || (!standing->changed() && first_force == scaled_force)) return false;
  const SelectiveSolution::Answer whole{solution, displacements};
  if (std::exchange(eliminated_along, false)) {
    (void)selective->begin(rows_to_change, whole);
    standing->forward_along(eliminated);
  } else {
    find_changed_rows(scaled_force);
    if (rows_to_change.empty()) return false;
    add_rows_of(loaded_nodes);
    std::sort(rows_to_change.begin(), rows_to_change.end());
    rows_to_change.erase(std::unique(rows_to_change.begin(), rows_to_change.end()), rows_to_change.end());
    const std::vector<char>& paths = selective->begin(rows_to_change, whole);
    rows->residual(system->matrix(), scaled_force, solution, rows_to_change, correction);
    standing->forward(correction, paths, eliminated);
  }
  selective->advance(rows_to_change, correction, eliminated, watch, whole);
  solved_force = scaled_force;
  stale_nodes.clear();
  loaded_nodes.clear();
  SolveQuality& quality = answer.quality;
  quality.backward_error = rows->error(system->matrix(), scaled_force, solution, rows_to_change);
  if (!(quality.backward_error <= acceptable_error)) return false;
  quality.converged = quality.backward_error <= backward_error_limit;
  quality.condition = current_condition();
  quality.error_bound = forward_error_bound(quality.condition, quality.backward_error);
  tell_effort();
  return true;
}

void Reanalysis::State::tell_effort() {
  const SelectiveSolution::Effort& done = selective->effort();
  effort = {true,        done.entries,  standing->triangles().entries(), done.beams, done.shells,
            done.energy, done.left_out, selective->bound_left_out()};
  operations += standing->solve_operations() * (1 + done.entries / effort.factor_entries) / 2;
  ++counters.selective;
  counters.beams_visited += static_cast<std::uint64_t>(done.beams);
  counters.beams_left += system->model.beams.size() - static_cast<std::uint64_t>(done.beams);
}

const std::vector<Vec6>& Reanalysis::State::whole() const {
  if (!selective || !selective->partial()) return displacements;
  if (!whole_known) find_whole();
  return whole_displacements;
}

/// As complete(), beside the answer, to what a selective one is held to.
void Reanalysis::State::find_whole() const {
  SelectiveSolution beside = *selective;
  Eigen::VectorXd u = solution;
  whole_displacements = displacements;
  beside.complete({u, whole_displacements}, nullptr);
  whole_known = true;
  if (!answer.stable || !structure_stands || !stale_nodes.empty()) return;
  double error = 0;
  system->node_displacements_of_scaled(refine_to(acceptable_error, solved_force, std::move(u), error),
                                       whole_displacements);
}

/// The displacements of what was left out; where the structure stands, with the backward error of a full answer.
void Reanalysis::State::complete(UseWatch* watch) {
  if (!selective) return;
  const bool behind = selective->partial();
  if (!behind && (watch == nullptr || !selective->unread())) return;
  eliminated_along = false;
  selective->complete({solution, displacements}, watch);
  if (!behind) return;
  effort.selective = whole_known = false;
  reactions.clear();
  if (!answer.stable || !structure_stands || !stale_nodes.empty()) return;
  SolveQuality& quality = answer.quality;
  quality.backward_error = rows->residual(system->matrix(), solved_force, solution, correction);
  operations += standing->solve_operations() / 2;
  if (!(quality.backward_error <= backward_error_limit)) {
    improve(solved_force, false);
    system->node_displacements_of_scaled(solution, displacements);
  }
  quality.converged = quality.backward_error <= backward_error_limit;
  quality.error_bound = forward_error_bound(quality.condition, quality.backward_error);
}

bool Reanalysis::uses_known() const { return state_->selective && state_->selective->uses_known(); }
const ReanalysisAnswer& Reanalysis::solve(UseWatch& watch) {
  if (!model().patches.empty()) throw std::invalid_argument("patches have no uses to watch: call solve()");
  return state_->solve(&watch);
}
void Reanalysis::complete(UseWatch* watch) { state_->complete(watch); }
void Reanalysis::forget_uses() {
  if (state_->selective) state_->selective->forget_growths();
}
void Reanalysis::forget_references() {
  if (state_->selective) state_->selective->forget_uses();
}

}  // namespace topple::solver
