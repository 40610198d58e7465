// Answers selective to where they may matter, and what makes them whole again.
#include <stdexcept>
#include <utility>

#include "reanalysis/reanalysis_state.h"

namespace topple::solver {

void Reanalysis::State::begin_selective() {
  const auto stiffness_of = [this](int beam) -> const BeamStrainForces& {
    return strain_forces.of(*system, static_cast<std::size_t>(beam));
  };
  selective = std::make_unique<SelectiveSolution>(*system, serving->base()->triangles(), stiffness_of);
}

void Reanalysis::State::read_all_utilisations(UtilisationWatch& watch) {
  BaseFactor* const base = serving->base();
  if (base == nullptr) return;
  if (!selective) begin_selective();
  if (selective->uses_known()) return;
  complete(nullptr);
  selective->read_all(watch);
}

bool Reanalysis::State::answer_in_part(UtilisationWatch& watch) {
  if (serving->base() == nullptr || !selective || !selective->uses_known()) return false;
  if (!solution.solve_in_part(*serving, load.vector().force, *selective, watch, answer.quality)) return false;
  report_effort();
  return true;
}

void Reanalysis::State::report_effort() {
  const SelectiveSolution::Effort& done = selective->effort();
  const BaseFactor& base = *serving->base();
  effort = {true,        done.entries,  base.triangles().entries(), done.beams, done.shells,
            done.energy, done.left_out, selective->bound_left_out()};
  work.operations += base.solve_operations() * (1 + done.entries / effort.factor_entries) / 2;
  ++work.counters.selective;
  work.counters.beams_visited += static_cast<std::uint64_t>(done.beams);
  work.counters.beams_left += system->model.beams.size() - static_cast<std::uint64_t>(done.beams);
}

const std::vector<Vec6>& Reanalysis::State::whole() const {
  if (!selective || !selective->partial()) return solution.displacements();
  if (!whole_known) find_whole();
  return whole_displacements;
}

/// As complete(), beside the answer, to what a selective one is held to.
void Reanalysis::State::find_whole() const {
  SelectiveSolution beside = *selective;
  Eigen::VectorXd u = solution.vector();
  whole_displacements = solution.displacements();
  beside.complete({u, whole_displacements}, nullptr);
  whole_known = true;
  if (!stands() || !solution.fits_structure()) return;
  double error = 0;
  system->node_displacements_of_scaled(
      serving->refine_to(acceptable_error, solution.right_hand_side(), std::move(u), error), whole_displacements);
}

/// The displacements of what was left out; where the structure stands, with the backward error of a full answer.
void Reanalysis::State::complete(UtilisationWatch* watch) {
  if (!selective) return;
  const bool behind = selective->partial();
  if (!behind && (watch == nullptr || !selective->unread())) return;
  solution.forget_elimination();
  selective->complete(solution.answer(), watch);
  if (!behind) return;
  effort.selective = whole_known = false;
  reactions.clear();
  if (stands() && solution.fits_structure()) solution.refine_whole(*serving, answer.quality, work);
}

bool Reanalysis::uses_known() const { return state_->selective && state_->selective->uses_known(); }
const ReanalysisAnswer& Reanalysis::solve(UtilisationWatch& watch) {
  if (!model().patches.empty()) throw std::invalid_argument("patches have no uses to watch: call solve()");
  return state_->solve(&watch);
}
void Reanalysis::complete(UtilisationWatch* watch) { state_->complete(watch); }
void Reanalysis::forget_utilisations() {
  if (state_->selective) state_->selective->forget_growths();
}
void Reanalysis::forget_references() {
  if (state_->selective) state_->selective->forget_utilisations();
}

Eigen::MatrixXd Reanalysis::State::answers_between(const Eigen::MatrixXd& F, const Eigen::MatrixXd& G) {
  catch_up();
  Eigen::MatrixXd X = G;
  BaseFactor* const base = serving->base();
  if (base == nullptr || serving->is_soft()) {
    for (Eigen::Index j = 0; j < X.cols(); ++j) {
      Eigen::VectorXd x = X.col(j);
      solve_as_it_stands(x);
      X.col(j) = x;
    }
    return F.transpose() * X;
  }
  std::vector<int> loaded;
  for (Eigen::Index row = 0; row < F.rows(); ++row)
    if ((F.row(row).array() != 0).any()) loaded.push_back(static_cast<int>(row));
  std::vector<char> known;
  base->solve_on_paths(X, loaded, known);
  count_answer(1);
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(F.cols(), G.cols());
  for (const int row : loaded) result += F.row(row).transpose() * X.row(row);
  return result;
}

}  // namespace topple::solver
