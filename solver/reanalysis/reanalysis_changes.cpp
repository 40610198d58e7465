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
    : system(std::make_unique<FrameSystem>(std::move(model))),
      options(given),
      changes(system->model),
      load(system->model),
      strain_forces(system->model.beams.size()),
      solution(system->model.nodes.size()) {
  serving.emplace(*system, options);
}

void Reanalysis::State::apply_changes() {
  touched_nodes.clear();
  apply_supports(touched_nodes);
  apply_dropped_nodes(touched_nodes);
  apply_beams(touched_nodes);
  apply_shells(touched_nodes);
  changes.clear();
  load.update(*system);
}

void Reanalysis::State::apply_supports(std::vector<int>& touched) {
  bool pattern_changes = false;
  for (const auto& [support, stiffness] : changes.supports()) {
    const Support& old = system->model.supports[static_cast<std::size_t>(support)];
    if (old.stiffness == stiffness) continue;
    for (int c = 0; c < 6; ++c) pattern_changes |= std::isinf(old.stiffness(c)) != std::isinf(stiffness(c));
    touched.push_back(old.node);
    system->set_support(support, stiffness);
  }
  if (pattern_changes) rebuild();
}

void Reanalysis::State::renumber(FrameModel model) {
  auto fresh = std::make_unique<FrameSystem>(std::move(model));
  fresh->beam_factor = system->beam_factor;
  fresh->beam_stands = system->beam_stands;
  fresh->shell_stands = system->shell_stands;
  fresh->node_stands = system->node_stands;
  fresh->second_order = system->second_order;
  fresh->inertia = system->inertia;
  serving.reset();
  system = std::move(fresh);
  serving.emplace(*system, options);
}

/// A freedom became free or held: the equations are numbered and ordered anew.
void Reanalysis::State::rebuild() {
  complete(nullptr);
  selective.reset();
  refresh.drop();
  renumber(system->model);
  solution.forget();
  load.forget();
  assembled = structure_stands = false;
}

void Reanalysis::State::apply_dropped_nodes(std::vector<int>& touched) {
  for (const int node : changes.dropped_nodes()) {
    char& stands = system->node_stands[static_cast<std::size_t>(node)];
    if (stands == 0) continue;
    for (int patch : system->patches_of_node(node)) {
      remember_plate(system->element_of_patch(patch));
      const auto& nodes = system->model.patches[static_cast<std::size_t>(patch)].node;
      touched.insert(touched.end(), nodes.begin(), nodes.end());
    }
    stands = 0;
    report_factors([&](SystemChanges& one) { one.drop_node(node); });
    solution.rest(*system, node);
    touched.push_back(node);
    load.touch(node);
    for (int beam : system->beams_of_node(node)) changes.mark_beam(beam);
    for (int shell : system->shells_of_node(node)) changes.mark_shell(shell);
  }
}

void Reanalysis::State::apply_beams(std::vector<int>& touched) {
  for (const int beam : changes.sorted_beams()) apply_beam(beam, touched);
}

void Reanalysis::State::apply_beam(int index, std::vector<int>& touched) {
  const auto i = static_cast<std::size_t>(index);
  const BeamTarget& target = changes.beam(i);
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
  if (stiffness_changed) report_factors([&](SystemChanges& one) { one.remember_beam(index); });
  if (stiffness_changed && selective && may_be_stiffer(beam, system->beam_stands[i], system->beam_factor[i], target))
    selective->forget_growths();
  beam.end_stiffness = target.end_stiffness;
  beam.density = target.density;
  system->beam_factor[i] = target.factor;
  system->beam_stands[i] = stands;
  if (stiffness_changed) touched.insert(touched.end(), beam.node.begin(), beam.node.end());
  load.set_beam(index, beam, system->fixed_end_forces(index, target.loads));
  if (selective) solution.touch_loaded(beam.node);
  strain_forces.forget(i);
}

/// To be told before the element changes.
void Reanalysis::State::remember_plate(std::size_t element) {
  const auto remembers = [&](BaseFactor* one) { return one == nullptr || one->changes().remember_plate(element); };
  if (!remembers(refresh.base())) refresh.drop();
  if (remembers(serving->base())) return;
  complete(nullptr);
  selective.reset();
  serving->forget_base();
  refresh.drop();
}

void Reanalysis::State::apply_given_stiffness(std::vector<int>& touched) {
  if (changes.shell_stiffness().empty() && changes.patch_stiffness().empty() && changes.patch_mass().empty()) return;
  // What uses can grow by was read from other matrices.
  complete(nullptr);
  if (selective) selective->forget_growths();
  for (const auto& [index, stiffness] : changes.shell_stiffness()) {
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
  replace(changes.patch_stiffness(), &Patch::stiffness);
  replace(changes.patch_mass(), &Patch::mass);
}

void Reanalysis::State::apply_shells(std::vector<int>& touched) {
  apply_given_stiffness(touched);
  for (const int index : changes.shells()) {
    const auto i = static_cast<std::size_t>(index);
    const auto& nodes = system->model.shells[i].node;
    const auto node_stands = [&](int n) { return system->node_stands[static_cast<std::size_t>(n)] != 0; };
    // A superelement goes on without a corner at which nothing of it is left.
    const bool on_standing_nodes = system->model.shell_stiffness.contains(index)
                                       ? std::any_of(nodes.begin(), nodes.end(), node_stands)
                                       : std::all_of(nodes.begin(), nodes.end(), node_stands);
    const char stands = !changes.shell_removed(i) && on_standing_nodes ? 1 : 0;
    if (stands == system->shell_stands[i]) continue;
    if (system->model.shell_stiffness.contains(index))
      remember_plate(system->element_of_shell(index));
    else
      report_factors([&](SystemChanges& one) { one.remember_shell(index); });
    system->shell_stands[i] = stands;
    if (stands != 0 && selective) selective->forget_growths();
    touched.insert(touched.end(), nodes.begin(), nodes.end());
  }
}

}  // namespace topple::solver
