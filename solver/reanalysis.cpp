#include "topple/solver/reanalysis.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "beam_energy.h"
#include "factor.h"
#include "frame_system.h"
#include "mechanism.h"
#include "refinement.h"
#include "topple/solver/beam_diagram.h"

namespace topple::solver {
namespace {

bool same(const BeamLoad& a, const BeamLoad& b) {
  return a.kind == b.kind && a.from == b.from && a.to == b.to && a.first == b.first && a.last == b.last &&
         a.strain == b.strain && a.curvature_y == b.curvature_y && a.curvature_z == b.curvature_z;
}

bool same(const std::vector<BeamLoad>& a, const std::vector<BeamLoad>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const BeamLoad& x, const BeamLoad& y) { return same(x, y); });
}

}  // namespace

/// What a beam is to be after the next solve().
struct BeamTarget {
  std::array<Vec6, 2> end_stiffness;
  bool removed = false;
  double factor = 1;
  std::vector<BeamLoad> loads;
};

struct Reanalysis::State {
  std::unique_ptr<FrameSystem> system;
  AnalysisOptions options;
  std::unique_ptr<Factor> factor;
  bool assembled = false, factor_valid = false;

  // Targets, and which of them differ from what the system has.
  std::vector<BeamTarget> targets;
  std::vector<int> changed_beams, changed_shells;
  std::vector<char> shell_removed;
  std::vector<Vec6> node_loads;
  bool node_loads_changed = false;
  std::vector<int> dropped_nodes;
  std::vector<std::pair<int, Vec6>> changed_supports;

  // The answer.
  bool answered = false;
  ReanalysisAnswer answer;
  double condition = 0;
  std::vector<Vec6> displacements;
  std::vector<Vec12> fixed_end;  ///< per beam, local
  std::vector<char> unbalanced;  ///< per beam: loaded in a loose direction
  mutable std::vector<Vec6> reactions;
  ReanalysisCounters counters;
  double operations = 0;

  State(FrameModel model, const AnalysisOptions& given);
  void mark(int beam);
  [[nodiscard]] bool pending() const;
  /// Each applies one kind of change to the system and adds the nodes whose stiffness it touched; true when it changed
  /// any stiffness.
  void apply_supports(std::vector<int>& touched);
  void apply_dropped_nodes(std::vector<int>& touched);
  void apply_beams(std::vector<int>& touched);
  void apply_shells(std::vector<int>& touched);
  void rebuild();
  [[nodiscard]] std::optional<Defect> refactorise(const std::vector<int>& touched);
  [[nodiscard]] LoadVector load_vector() const;
  void solve_loads(const LoadVector& load);
  void give_up(const Defect& defect);
  [[nodiscard]] LinearSolve linear_solve() const {
    return [this](Eigen::Ref<Eigen::MatrixXd> b) { factor->solve(b); };
  }
  [[nodiscard]] Eigen::VectorXd solve_scaled(const Eigen::VectorXd& force, SolveQuality& quality) const;
  [[nodiscard]] std::size_t checked_beam(int beam) const;
  [[nodiscard]] std::size_t checked_shell(int shell) const;
  void set_shell_removed(int shell, bool removed);
};

Reanalysis::State::State(FrameModel model, const AnalysisOptions& given)
    : system(std::make_unique<FrameSystem>(std::move(model))), options(given) {
  const FrameModel& m = system->model;
  for (const Beam& beam : m.beams) targets.push_back({beam.end_stiffness, false, 1, {}});
  shell_removed.assign(m.shells.size(), 0);
  node_loads.assign(m.nodes.size(), Vec6::Zero());
  displacements.assign(m.nodes.size(), Vec6::Zero());
  fixed_end.assign(m.beams.size(), Vec12::Zero());
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

void Reanalysis::State::set_shell_removed(int shell, bool removed) {
  char& target = shell_removed[checked_shell(shell)];
  if ((target != 0) == removed) return;
  target = removed ? 1 : 0;
  changed_shells.push_back(shell);
}

void Reanalysis::State::mark(int beam) { changed_beams.push_back(beam); }

bool Reanalysis::State::pending() const {
  return !answered || !changed_beams.empty() || !changed_shells.empty() || node_loads_changed ||
         !dropped_nodes.empty() || !changed_supports.empty();
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
  auto fresh = std::make_unique<FrameSystem>(system->model);
  fresh->beam_factor = system->beam_factor;
  fresh->beam_stands = system->beam_stands;
  fresh->shell_stands = system->shell_stands;
  fresh->node_stands = system->node_stands;
  system = std::move(fresh);
  factor.reset();
  assembled = factor_valid = false;
}

void Reanalysis::State::apply_dropped_nodes(std::vector<int>& touched) {
  for (int node : dropped_nodes) {
    char& stands = system->node_stands[static_cast<std::size_t>(node)];
    if (stands == 0) continue;
    stands = 0;
    touched.push_back(node);
    for (int beam : system->beams_of_node(node)) changed_beams.push_back(beam);
    for (int shell : system->shells_of_node(node)) changed_shells.push_back(shell);
  }
  dropped_nodes.clear();
}

void Reanalysis::State::apply_beams(std::vector<int>& touched) {
  std::sort(changed_beams.begin(), changed_beams.end());
  changed_beams.erase(std::unique(changed_beams.begin(), changed_beams.end()), changed_beams.end());
  for (int index : changed_beams) {
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
        (stands != 0 && (beam.end_stiffness[0] != target.end_stiffness[0] ||
                         beam.end_stiffness[1] != target.end_stiffness[1] || system->beam_factor[i] != target.factor));
    beam.end_stiffness = target.end_stiffness;
    system->beam_factor[i] = target.factor;
    system->beam_stands[i] = stands;
    if (stiffness_changed) touched.insert(touched.end(), beam.node.begin(), beam.node.end());
    const FixedEndForces fixed = system->fixed_end_forces(index, target.loads);
    fixed_end[i] = fixed.force;
    unbalanced[i] = fixed.unbalanced > 0 ? 1 : 0;
  }
  changed_beams.clear();
}

void Reanalysis::State::apply_shells(std::vector<int>& touched) {
  for (int index : changed_shells) {
    const auto i = static_cast<std::size_t>(index);
    const auto& nodes = system->model.shells[i].node;
    const bool on_standing_nodes = std::all_of(
        nodes.begin(), nodes.end(), [&](int n) { return system->node_stands[static_cast<std::size_t>(n)] != 0; });
    const char stands = shell_removed[i] == 0 && on_standing_nodes ? 1 : 0;
    if (stands == system->shell_stands[i]) continue;
    system->shell_stands[i] = stands;
    touched.insert(touched.end(), nodes.begin(), nodes.end());
  }
  changed_shells.clear();
}

std::optional<Defect> Reanalysis::State::refactorise(const std::vector<int>& touched) {
  factor_valid = false;
  if (assembled) {
    system->reassemble(touched);
  } else {
    system->assemble();
    assembled = true;
  }
  if (auto defect = system->defect()) return defect;
  if (system->dofs().equations == 0) {  // everything is held: nothing to factorise, every answer is exact
    factor_valid = true;
    return std::nullopt;
  }
  if (!factor) {
    factor = std::make_unique<Factor>(system->matrix(), system->elimination_order(), options.factorisation);
    ++counters.orderings;
  } else {
    ++counters.refactorisations;
  }
  operations += factor->operations();
  const Stability stability = factorise_and_judge(*system, *factor, options);
  if (stability.defect) return stability.defect;
  factor_valid = true;
  condition = stability.condition > 0 ? stability.condition : estimate_condition(system->matrix(), linear_solve());
  answer.nearly_unstable = stability.nearly_unstable || 1 / condition < options.warning_limit;
  return std::nullopt;
}

LoadVector Reanalysis::State::load_vector() const {
  LoadVector load;
  const DofMap& dofs = system->dofs();
  load.force = Eigen::VectorXd::Zero(dofs.equations + dofs.held);
  load.held_displacement = Eigen::VectorXd::Zero(dofs.held);
  for (std::size_t n = 0; n < node_loads.size(); ++n) {
    if (system->node_stands[n] != 0) dofs.add_node_force(static_cast<int>(n), node_loads[n], load.force.data());
  }
  for (std::size_t i = 0; i < fixed_end.size(); ++i) {
    if (system->beam_stands[i] == 0) continue;
    system->add_fixed_end(static_cast<int>(i), fixed_end[i], load.force);
    if (unbalanced[i] != 0) load.unbalanced_beams.push_back(static_cast<int>(i));
  }
  return load;
}

Eigen::VectorXd Reanalysis::State::solve_scaled(const Eigen::VectorXd& force, SolveQuality& quality) const {
  const Eigen::Index n = system->dofs().equations;
  const Eigen::Map<const Eigen::VectorXd> scale(system->scale().data(), n);
  if (n == 0) return {};
  const RefinedSolution refined = solve_refined(system->matrix(), linear_solve(), force.head(n).cwiseProduct(scale));
  quality = refined.quality[0];
  quality.condition = condition;
  quality.error_bound = forward_error_bound(condition, quality.backward_error);
  return refined.x.col(0).cwiseProduct(scale);
}

void Reanalysis::State::solve_loads(const LoadVector& load) {
  const Eigen::VectorXd u = solve_scaled(load.force, answer.quality);
  displacements = system->node_displacements(u, load.held_displacement);
  if (factor) {
    const double passes = 1 + answer.quality.refinements;
    operations += passes * (4.0 * static_cast<double>(factor->entries()) +
                            4.0 * static_cast<double>(system->matrix().row.size()));
  }
}

void Reanalysis::State::give_up(const Defect& defect) {
  answer.stable = false;
  answer.mechanism = defect.motion;
}

Reanalysis::Reanalysis(FrameModel model, const AnalysisOptions& options)
    : state_(std::make_unique<State>(std::move(model), options)) {}
Reanalysis::~Reanalysis() = default;
Reanalysis::Reanalysis(Reanalysis&&) noexcept = default;
Reanalysis& Reanalysis::operator=(Reanalysis&&) noexcept = default;

void Reanalysis::set_end_stiffness(int beam, int end, const Vec6& stiffness) {
  if (end < 0 || end > 1) throw std::invalid_argument("a beam has end 0 and end 1, not " + std::to_string(end));
  if (!(stiffness.array() >= 0).all()) throw std::invalid_argument("end stiffness must be 0, a spring or rigid");
  Vec6& target = state_->targets[state_->checked_beam(beam)].end_stiffness[static_cast<std::size_t>(end)];
  if (target == stiffness) return;
  target = stiffness;
  state_->mark(beam);
}

void Reanalysis::remove_beam(int beam) {
  bool& removed = state_->targets[state_->checked_beam(beam)].removed;
  if (removed) return;
  removed = true;
  state_->mark(beam);
}

void Reanalysis::restore_beam(int beam) {
  bool& removed = state_->targets[state_->checked_beam(beam)].removed;
  if (!removed) return;
  removed = false;
  state_->mark(beam);
}

void Reanalysis::remove_shell(int shell) { state_->set_shell_removed(shell, true); }
void Reanalysis::restore_shell(int shell) { state_->set_shell_removed(shell, false); }

void Reanalysis::set_beam_stiffness_factor(int beam, double factor) {
  if (!(factor > 0) || !std::isfinite(factor)) throw std::invalid_argument("a stiffness factor must be above 0");
  double& target = state_->targets[state_->checked_beam(beam)].factor;
  if (target == factor) return;
  target = factor;
  state_->mark(beam);
}

void Reanalysis::set_support_stiffness(int support, const Vec6& stiffness) {
  if (support < 0 || static_cast<std::size_t>(support) >= model().supports.size()) {
    throw std::invalid_argument("support " + std::to_string(support) + " does not exist");
  }
  if (!(stiffness.array() >= 0).all()) throw std::invalid_argument("support stiffness must be 0, a spring or rigid");
  state_->changed_supports.emplace_back(support, stiffness);
}

void Reanalysis::drop_nodes(std::span<const int> nodes) {
  for (int node : nodes) {
    if (node < 0 || static_cast<std::size_t>(node) >= model().nodes.size()) {
      throw std::invalid_argument("node " + std::to_string(node) + " does not exist");
    }
    if (state_->system->node_stands[static_cast<std::size_t>(node)] != 0) state_->dropped_nodes.push_back(node);
  }
}

void Reanalysis::set_node_load(int node, const Vec6& load) {
  if (node < 0 || static_cast<std::size_t>(node) >= model().nodes.size()) {
    throw std::invalid_argument("node " + std::to_string(node) + " does not exist");
  }
  if (!load.allFinite()) throw std::invalid_argument("load on node " + std::to_string(node) + " is not finite");
  Vec6& target = state_->node_loads[static_cast<std::size_t>(node)];
  if (target == load) return;
  target = load;
  state_->node_loads_changed = true;
}

void Reanalysis::set_beam_loads(int beam, std::vector<BeamLoad> loads) {
  std::vector<BeamLoad>& target = state_->targets[state_->checked_beam(beam)].loads;
  for (BeamLoad& load : loads) load.beam = beam;
  if (same(target, loads)) return;
  target = std::move(loads);
  state_->mark(beam);
}

const ReanalysisAnswer& Reanalysis::solve() {
  State& state = *state_;
  state.operations = 0;
  if (!state.pending()) {
    ++state.counters.unchanged;
    return state.answer;
  }
  std::vector<int> touched;
  state.apply_supports(touched);
  state.apply_dropped_nodes(touched);
  state.apply_beams(touched);
  state.apply_shells(touched);
  state.node_loads_changed = false;
  state.answered = true;
  const bool nearly_unstable = state.answer.nearly_unstable;  // a property of the factor, which may stay
  state.answer = ReanalysisAnswer();
  state.answer.nearly_unstable = nearly_unstable;
  state.reactions.clear();
  ++state.counters.solves;
  if (!touched.empty() || !state.assembled || !state.factor_valid) {
    if (const auto defect = state.refactorise(touched)) {
      state.give_up(*defect);
      return state.answer;
    }
  } else {
    ++state.counters.load_solves;
  }
  const LoadVector load = state.load_vector();
  if (const auto defect = state.system->unbalanced_load(load)) {
    state.give_up(*defect);
    return state.answer;
  }
  state.solve_loads(load);
  return state.answer;
}

const std::vector<Vec6>& Reanalysis::displacements() const { return state_->displacements; }

Vec12 Reanalysis::beam_end_forces(int beam) const {
  const std::size_t i = state_->checked_beam(beam);
  return state_->system->end_forces(beam, state_->displacements, state_->fixed_end[i]);
}

std::array<Vec6, 4> Reanalysis::shell_corner_forces(int shell) const {
  (void)state_->checked_shell(shell);
  return state_->system->corner_forces(shell, state_->displacements, Vec24::Zero());
}

Vec6 Reanalysis::reaction(int support) const {
  const FrameSystem& system = *state_->system;
  if (support < 0 || static_cast<std::size_t>(support) >= system.model.supports.size()) {
    throw std::invalid_argument("support " + std::to_string(support) + " does not exist");
  }
  if (state_->reactions.empty()) {
    std::vector<Vec12> forces;
    forces.reserve(system.model.beams.size());
    for (std::size_t i = 0; i < system.model.beams.size(); ++i) forces.push_back(beam_end_forces(static_cast<int>(i)));
    std::vector<std::array<Vec6, 4>> corners;
    for (std::size_t i = 0; i < system.model.shells.size(); ++i) {
      corners.push_back(shell_corner_forces(static_cast<int>(i)));
    }
    state_->reactions = system.reactions(state_->displacements, forces, corners, state_->node_loads);
  }
  return state_->reactions[static_cast<std::size_t>(support)];
}

double Reanalysis::strain_energy() const {
  const FrameSystem& system = *state_->system;
  double energy = 0;
  for (std::size_t i = 0; i < system.model.beams.size(); ++i) {
    if (system.beam_stands[i] == 0) continue;
    energy += beam_strain_energy(system.model.beams[i], system.beam_factor[i], beam_end_forces(static_cast<int>(i)),
                                 state_->targets[i].loads);
  }
  for (std::size_t i = 0; i < system.model.shells.size(); ++i) {
    const std::array<Vec6, 4> corners = shell_corner_forces(static_cast<int>(i));
    for (std::size_t n = 0; n < 4; ++n) {
      energy += corners[n].dot(state_->displacements[static_cast<std::size_t>(system.model.shells[i].node[n])]) / 2;
    }
  }
  for (const Support& support : system.model.supports) {
    const Vec6& u = state_->displacements[static_cast<std::size_t>(support.node)];
    for (int c = 0; c < 6; ++c) {
      if (std::isfinite(support.stiffness(c))) energy += support.stiffness(c) * u(c) * u(c) / 2;
    }
  }
  return energy;
}

Reanalysis::Response Reanalysis::respond(const LoadSet& loads) const {
  const State& state = *state_;
  if (!state.answer.stable || !state.factor_valid) {
    throw Instability("the structure does not stand: it has no response", state.answer.mechanism);
  }
  const LoadVector load = state.system->load_vector(loads);
  if (const auto defect = state.system->unbalanced_load(load)) throw Instability(defect->message, defect->motion);
  SolveQuality quality;
  const Eigen::VectorXd u = state.solve_scaled(load.force, quality);
  Response response;
  response.displacements = state.system->node_displacements(u, load.held_displacement);
  response.beam_end_forces.reserve(state.targets.size());
  for (std::size_t i = 0; i < state.targets.size(); ++i) {
    const Vec12 fixed = load.beam_fixed_end.empty() ? Vec12::Zero() : load.beam_fixed_end[i];
    response.beam_end_forces.push_back(state.system->end_forces(static_cast<int>(i), response.displacements, fixed));
  }
  return response;
}

Vec3 Reanalysis::point_displacement(int beam, double distance, const std::vector<Vec6>& node_displacements,
                                    std::span<const BeamLoad> own) const {
  const std::size_t i = state_->checked_beam(beam);
  const FrameSystem& system = *state_->system;
  const Beam& b = system.model.beams[i];
  const Vec12 hubs = hub_displacements(b, node_displacements[static_cast<std::size_t>(b.node[0])],
                                       node_displacements[static_cast<std::size_t>(b.node[1])]);
  const Vec12 forces = system.end_forces(beam, node_displacements, system.fixed_end_forces(beam, own).force);
  const Vec6 local = BeamDiagram(b, forces, own, system.beam_factor[i]).displacement(distance, hubs);
  return b.axes.transpose() * local.head<3>();
}

const ReanalysisCounters& Reanalysis::counters() const { return state_->counters; }
const FrameModel& Reanalysis::model() const { return state_->system->model; }
double Reanalysis::last_operations() const { return state_->operations; }

}  // namespace topple::solver
