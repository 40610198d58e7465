// Changes that were asked for, carried into the system.
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "reanalysis/reanalysis_state.h"

namespace topple::solver {
namespace {

/// What a beam's use can grow by was read when it was no stiffer than before.
bool may_be_stiffer(const Beam& before, char stood, double factor, const BeamTarget& after) {
  if (stood == 0 || after.factor > factor) return true;
  for (std::size_t end = 0; end < 2; ++end)
    if ((after.end_stiffness[end].array() > before.end_stiffness[end].array()).any()) return true;
  return false;
}

}  // namespace

Reanalysis::State::State(FrameModel model, const AnalysisOptions& given)
    : system(std::make_unique<FrameSystem>(std::move(model))), options(given) {
  const FrameModel& m = system->model;
  for (const Beam& beam : m.beams) targets.push_back({beam.end_stiffness, false, 1, beam.density, {}});
  shell_removed.assign(m.shells.size(), 0);
  node_loads.assign(m.nodes.size(), Vec6::Zero());
  displacements.assign(m.nodes.size(), Vec6::Zero());
  fixed_end.assign(m.beams.size(), Vec12::Zero());
  fixed_at_nodes.assign(m.beams.size(), Vec12::Zero());
  strain_forces.resize(m.beams.size());
  strain_forces_known.assign(m.beams.size(), 0);
  unbalanced.assign(m.beams.size(), 0);
}

std::size_t Reanalysis::State::checked_beam(int beam) const {
  if (beam < 0 || static_cast<std::size_t>(beam) >= targets.size()) {
    throw std::invalid_argument("beam " + std::to_string(beam) + " does not exist");
  }
  return static_cast<std::size_t>(beam);
}

std::size_t Reanalysis::State::checked_shell(int shell) const {
  if (shell < 0 || static_cast<std::size_t>(shell) >= shell_removed.size()) {
    throw std::invalid_argument("shell " + std::to_string(shell) + " does not exist");
  }
  return static_cast<std::size_t>(shell);
}

std::size_t Reanalysis::State::checked_patch(int patch) const {
  if (patch < 0 || static_cast<std::size_t>(patch) >= system->model.patches.size()) {
    throw std::invalid_argument("patch " + std::to_string(patch) + " does not exist");
  }
  return static_cast<std::size_t>(patch);
}

void Reanalysis::State::set_shell_removed(int shell, bool removed) {
  char& target = shell_removed[checked_shell(shell)];
  if ((target != 0) == removed) return;
  target = removed ? 1 : 0;
  changed_shells.push_back(shell);
}

void Reanalysis::State::mark(int beam) { changed_beams.push_back(beam); }

bool Reanalysis::State::pending() const {
  return !answered || !changed_beams.empty() || !changed_shells.empty() || node_loads_changed ||
         !dropped_nodes.empty() || !changed_supports.empty() || !given_stiffness.empty() || !given_to_patch.empty() ||
         !given_mass.empty();
}

void Reanalysis::State::apply_supports(std::vector<int>& touched) {
  bool pattern_changes = false;
  for (const auto& [support, stiffness] : changed_supports) {
    const Support& old = system->model.supports[static_cast<std::size_t>(support)];
    if (old.stiffness == stiffness) continue;
    for (int c = 0; c < 6; ++c) pattern_changes |= std::isinf(old.stiffness(c)) != std::isinf(stiffness(c));
    touched.push_back(old.node);
    system->set_support(support, stiffness);
  }
  changed_supports.clear();
  if (pattern_changes) rebuild();
}

/// A freedom became free or held: the equations are numbered and ordered anew.
void Reanalysis::State::rebuild() {
  complete(nullptr);
  selective.reset();
  drop_refresh();
  auto fresh = std::make_unique<FrameSystem>(system->model);
  fresh->beam_factor = system->beam_factor;
  fresh->beam_stands = system->beam_stands;
  fresh->shell_stands = system->shell_stands;
  fresh->node_stands = system->node_stands;
  fresh->second_order = system->second_order;
  fresh->inertia = system->inertia;
  system = std::move(fresh);
  standing.reset();
  factor.reset();
  rows.reset();
  solution.resize(0);
  first_solution.resize(0);
  assembled = factor_valid = structure_stands = load_known = false;
}

void Reanalysis::State::apply_dropped_nodes(std::vector<int>& touched) {
  for (int node : dropped_nodes) {
    char& stands = system->node_stands[static_cast<std::size_t>(node)];
    if (stands == 0) continue;
    for (int patch : system->patches_of_node(node)) {
      remember_plate(system->element_of_patch(patch));
      const auto& nodes = system->model.patches[static_cast<std::size_t>(patch)].node;
      touched.insert(touched.end(), nodes.begin(), nodes.end());
    }
    stands = 0;
    tell_standing([&](BaseFactor& one) { one.drop_node(node); });
    // Corrections leave it alone from now on: the answer that they start from must have it at rest.
    const auto& first = system->dofs().first_equation;
    for (int e = first[static_cast<std::size_t>(node)]; e < first[static_cast<std::size_t>(node) + 1]; ++e)
      if (solution.size() > e) solution(e) = 0;
    touched.push_back(node);
    stale_load_nodes.push_back(node);
    for (int beam : system->beams_of_node(node)) changed_beams.push_back(beam);
    for (int shell : system->shells_of_node(node)) changed_shells.push_back(shell);
  }
  dropped_nodes.clear();
}

void Reanalysis::State::apply_beams(std::vector<int>& touched) {
  std::sort(changed_beams.begin(), changed_beams.end());
  changed_beams.erase(std::unique(changed_beams.begin(), changed_beams.end()), changed_beams.end());
  for (const int beam : changed_beams) apply_beam(beam, touched);
  changed_beams.clear();
}

void Reanalysis::State::apply_beam(int index, std::vector<int>& touched) {
  const auto i = static_cast<std::size_t>(index);
  const BeamTarget& target = targets[i];
  Beam& beam = system->model.beams[i];
  // A beam with a broken end does not hang on the node there: it stands as a cantilever when that node has left.
  const auto free_of_dropped = [&](std::size_t end) {
    return system->node_stands[static_cast<std::size_t>(beam.node[end])] != 0 || target.end_stiffness[end].isZero(0);
  };
  const char stands = !target.removed && free_of_dropped(0) && free_of_dropped(1) ? 1 : 0;
  const bool stiffness_changed =
      stands != system->beam_stands[i] ||
      (stands != 0 &&
       (beam.end_stiffness[0] != target.end_stiffness[0] || beam.end_stiffness[1] != target.end_stiffness[1] ||
        system->beam_factor[i] != target.factor || beam.density != target.density));
  if (stiffness_changed) tell_standing([&](BaseFactor& one) { one.remember_beam(index); });
  if (stiffness_changed && selective && may_be_stiffer(beam, system->beam_stands[i], system->beam_factor[i], target))
    selective->forget_growths();
  beam.end_stiffness = target.end_stiffness;
  beam.density = target.density;
  system->beam_factor[i] = target.factor;
  system->beam_stands[i] = stands;
  if (stiffness_changed) touched.insert(touched.end(), beam.node.begin(), beam.node.end());
  const FixedEndForces fixed = system->fixed_end_forces(index, target.loads);
  fixed_end[i] = fixed.force;
  fixed_at_nodes[i] = -node_forces(beam, fixed.force);
  stale_load_nodes.insert(stale_load_nodes.end(), beam.node.begin(), beam.node.end());
  if (selective) loaded_nodes.insert(loaded_nodes.end(), beam.node.begin(), beam.node.end());
  strain_forces_known[i] = 0;
  unbalanced[i] = fixed.unbalanced > 0 ? 1 : 0;
}

/// To be told before the element changes.
void Reanalysis::State::remember_plate(std::size_t element) {
  const auto remembers = [&](std::unique_ptr<BaseFactor>& one) { return !one || one->remember_plate(element); };
  if (!remembers(next)) drop_refresh();
  if (remembers(standing)) return;
  complete(nullptr);
  selective.reset();
  standing.reset();
  drop_refresh();
}

void Reanalysis::State::apply_given_stiffness(std::vector<int>& touched) {
  if (given_stiffness.empty() && given_to_patch.empty() && given_mass.empty()) return;
  // What uses can grow by was read from other matrices.
  complete(nullptr);
  if (selective) selective->forget_growths();
  for (const auto& [index, stiffness] : given_stiffness) {
    remember_plate(system->element_of_shell(index));
    const auto& nodes = system->model.shells[static_cast<std::size_t>(index)].node;
    system->model.shell_stiffness[index] = stiffness;
    touched.insert(touched.end(), nodes.begin(), nodes.end());
  }
  const auto replace = [&](const std::map<int, Eigen::MatrixXd>& given, Eigen::MatrixXd Patch::*matrix) {
    for (const auto& [index, now] : given) {
      remember_plate(system->element_of_patch(index));
      Patch& patch = system->model.patches[static_cast<std::size_t>(index)];
      patch.*matrix = now;
      touched.insert(touched.end(), patch.node.begin(), patch.node.end());
    }
  };
  replace(given_to_patch, &Patch::stiffness);
  replace(given_mass, &Patch::mass);
  given_stiffness.clear();
  given_to_patch.clear();
  given_mass.clear();
}

void Reanalysis::State::apply_shells(std::vector<int>& touched) {
  apply_given_stiffness(touched);
  for (int index : changed_shells) {
    const auto i = static_cast<std::size_t>(index);
    const auto& nodes = system->model.shells[i].node;
    const auto node_stands = [&](int n) { return system->node_stands[static_cast<std::size_t>(n)] != 0; };
    // A superelement goes on without a corner at which nothing of it is left.
    const bool on_standing_nodes = system->model.shell_stiffness.contains(index)
                                       ? std::any_of(nodes.begin(), nodes.end(), node_stands)
                                       : std::all_of(nodes.begin(), nodes.end(), node_stands);
    const char stands = shell_removed[i] == 0 && on_standing_nodes ? 1 : 0;
    if (stands == system->shell_stands[i]) continue;
    if (system->model.shell_stiffness.contains(index))
      remember_plate(system->element_of_shell(index));
    else
      tell_standing([&](BaseFactor& one) { one.remember_shell(index); });
    system->shell_stands[i] = stands;
    if (stands != 0 && selective) selective->forget_growths();
    touched.insert(touched.end(), nodes.begin(), nodes.end());
  }
  changed_shells.clear();
}

}  // namespace topple::solver
