#include "topple/solver/reanalysis.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "assembly/checked_index.h"
#include "assembly/frame_loads.h"
#include "assembly/frame_recovery.h"
#include "elements/beam_energy.h"
#include "reanalysis/reanalysis_state.h"
#include "topple/solver/beam_diagram.h"

namespace topple::solver {

Reanalysis::Reanalysis(FrameModel model, const AnalysisOptions& options)
    : state_(std::make_unique<State>(std::move(model), options)) {}
Reanalysis::~Reanalysis() = default;
Reanalysis::Reanalysis(Reanalysis&&) noexcept = default;
Reanalysis& Reanalysis::operator=(Reanalysis&&) noexcept = default;

void Reanalysis::set_end_stiffness(int beam, int end, const Vec6& stiffness) {
  if (end < 0 || end > 1) throw std::invalid_argument("a beam has end 0 and end 1, not " + std::to_string(end));
  if (!(stiffness.array() >= 0).all()) throw std::invalid_argument("end stiffness must be 0, a spring or rigid");
  state_->changes.set_end_stiffness(checked_beam(model(), beam), static_cast<std::size_t>(end), stiffness);
}

void Reanalysis::remove_beam(int beam) { state_->changes.set_beam_removed(checked_beam(model(), beam), true); }
void Reanalysis::restore_beam(int beam) { state_->changes.set_beam_removed(checked_beam(model(), beam), false); }
void Reanalysis::remove_shell(int shell) { state_->changes.set_shell_removed(checked_shell(model(), shell), true); }
void Reanalysis::restore_shell(int shell) { state_->changes.set_shell_removed(checked_shell(model(), shell), false); }

Eigen::Matrix<double, 24, 24> Reanalysis::shell_stiffness(int shell) const {
  (void)checked_shell(model(), shell);
  return state_->system->shell_node_stiffness(shell);
}

void Reanalysis::set_shell_stiffness(int shell, const Eigen::Matrix<double, 24, 24>& stiffness) {
  (void)checked_shell(model(), shell);
  if (!stiffness.allFinite())
    throw std::invalid_argument("stiffness of shell " + std::to_string(shell) + " is not finite");
  state_->changes.set_shell_stiffness(shell, stiffness);
}

void Reanalysis::set_patch_stiffness(int patch, Eigen::MatrixXd stiffness) {
  const Patch& own = model().patches[checked_patch(model(), patch)];
  if (stiffness.rows() != own.stiffness.rows() || stiffness.cols() != own.stiffness.cols() || !stiffness.allFinite())
    throw std::invalid_argument("stiffness of patch " + std::to_string(patch) + " is not a finite matrix of its size");
  state_->changes.set_patch_stiffness(patch, std::move(stiffness));
}

const Eigen::MatrixXd& Reanalysis::patch_stiffness(int patch) const {
  return model().patches[checked_patch(model(), patch)].stiffness;
}

std::vector<Vec6> Reanalysis::patch_forces(int patch) const {
  (void)checked_patch(model(), patch);
  return state_->system->patch_forces(patch, state_->whole());
}

void Reanalysis::set_beam_stiffness_factor(int beam, double factor) {
  if (!(factor > 0) || !std::isfinite(factor)) throw std::invalid_argument("a stiffness factor must be above 0");
  state_->changes.set_beam_factor(checked_beam(model(), beam), factor);
}

void Reanalysis::set_support_stiffness(int support, const Vec6& stiffness) {
  (void)checked_support(model(), support);
  if (!(stiffness.array() >= 0).all()) throw std::invalid_argument("support stiffness must be 0, a spring or rigid");
  state_->changes.set_support(support, stiffness);
}

void Reanalysis::drop_nodes(std::span<const int> nodes) {
  for (const int node : nodes)
    if (state_->system->node_stands[checked_node(model(), node)] != 0) state_->changes.drop_node(node);
}

void Reanalysis::set_node_load(int node, const Vec6& load) {
  (void)checked_node(model(), node);
  if (!load.allFinite()) throw std::invalid_argument("load on node " + std::to_string(node) + " is not finite");
  state_->load.set_node(node, load);
}

void Reanalysis::set_beam_loads(int beam, std::vector<BeamLoad> loads) {
  state_->changes.set_beam_loads(checked_beam(model(), beam), std::move(loads));
}

const std::vector<Vec6>& Reanalysis::displacements() const { return state_->whole(); }

const std::vector<Vec6>& Reanalysis::displacements_at(std::span<const int> nodes) const {
  const State& state = *state_;
  const bool here = !state.selective || std::all_of(nodes.begin(), nodes.end(),
                                                    [&](int node) { return state.selective->node_is_current(node); });
  return here ? state.solution.displacements() : state.whole();
}

Vec12 Reanalysis::State::end_forces(std::size_t i, const std::vector<Vec6>& u, const Vec12& fixed) const {
  if (system->beam_stands[i] == 0) return Vec12::Zero();
  const Beam& beam = system->model.beams[i];
  const Vec12 rigid_ends = rigid_end_displacements(beam, u[static_cast<std::size_t>(beam.node[0])],
                                                   u[static_cast<std::size_t>(beam.node[1])]);
  return strain_forces.of(*system, i)(relative_motion(beam.length, rigid_ends)) + fixed;
}

Vec12 Reanalysis::beam_end_forces(int beam) const {
  const std::size_t i = checked_beam(model(), beam);
  const bool here = !state_->selective || state_->selective->beam_is_current(beam);
  return state_->end_forces(i, here ? state_->solution.displacements() : state_->whole(), state_->load.fixed_end(i));
}

std::array<Vec6, 4> Reanalysis::shell_corner_forces(int shell) const {
  (void)checked_shell(model(), shell);
  const bool here = !state_->selective || state_->selective->shell_is_current(shell);
  return state_->system->corner_forces(shell, here ? state_->solution.displacements() : state_->whole(), Vec24::Zero());
}

Vec6 Reanalysis::reaction(int support) const {
  const std::size_t i = checked_support(model(), support);
  if (state_->reactions.empty())
    state_->reactions = state_->reactions_of(
        state_->whole(), [&](int beam) { return beam_end_forces(beam); },
        [&](int shell) { return shell_corner_forces(shell); });
  return state_->reactions[i];
}

double Reanalysis::strain_energy() const {
  const std::vector<Vec6>& displacements = state_->whole();
  const FrameSystem& system = *state_->system;
  double energy = 0;
  for (std::size_t i = 0; i < system.model.beams.size(); ++i) {
    if (system.beam_stands[i] == 0) continue;
    energy += beam_strain_energy(system.model.beams[i], system.beam_factor[i], beam_end_forces(static_cast<int>(i)),
                                 state_->changes.beam(i).loads);
  }
  for (std::size_t i = 0; i < system.model.shells.size(); ++i) {
    const std::array<Vec6, 4> corners = shell_corner_forces(static_cast<int>(i));
    for (std::size_t n = 0; n < 4; ++n) {
      energy += corners[n].dot(displacements[static_cast<std::size_t>(system.model.shells[i].node[n])]) / 2;
    }
  }
  for (std::size_t i = 0; i < system.model.patches.size(); ++i) {
    const std::vector<Vec6> forces = patch_forces(static_cast<int>(i));
    for (std::size_t n = 0; n < forces.size(); ++n)
      energy += forces[n].dot(displacements[static_cast<std::size_t>(system.model.patches[i].node[n])]) / 2;
  }
  for (const Support& support : system.model.supports) {
    const Vec6& u = displacements[static_cast<std::size_t>(support.node)];
    for (int c = 0; c < 6; ++c) {
      if (std::isfinite(support.stiffness(c))) energy += support.stiffness(c) * u(c) * u(c) / 2;
    }
  }
  return energy;
}

namespace {

std::vector<std::pair<int, Vec12>> fixed_end_of(const LoadSet& loads, const LoadVector& load) {
  std::vector<std::pair<int, Vec12>> fixed_end;
  for (const BeamLoad& one : loads.beams)
    fixed_end.emplace_back(one.beam, load.beam_fixed_end[static_cast<std::size_t>(one.beam)]);
  std::sort(fixed_end.begin(), fixed_end.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  return fixed_end;
}

}  // namespace

Reanalysis::Response Reanalysis::respond(const LoadSet& loads) const { return std::move(respond({&loads, 1}).front()); }

Reanalysis::Response Reanalysis::respond_near(const LoadSet& loads, std::vector<char>& known) const {
  return std::move(respond_near({&loads, 1}, known).front());
}

Eigen::MatrixXd Reanalysis::State::forces_on_standing(std::span<const LoadSet> loads,
                                                      std::vector<LoadVector>& own) const {
  if (!stands()) throw Instability("the structure does not stand: it has no response", answer.mechanism);
  Eigen::MatrixXd forces;
  for (std::size_t i = 0; i < loads.size(); ++i) {
    own.push_back(load_vector(*system, loads[i]));
    system->drop_idle_loads(own[i]);
    require_none(system->unbalanced_load(own[i], negligible_lever));
    if (i == 0) forces.resize(own[0].force.size(), static_cast<Eigen::Index>(loads.size()));
    forces.col(static_cast<Eigen::Index>(i)) = own[i].force;
  }
  return forces;
}

std::vector<Reanalysis::Response> Reanalysis::respond(std::span<const LoadSet> loads) const {
  const State& state = *state_;
  if (loads.empty()) return {};
  std::vector<LoadVector> own;
  std::vector<double> errors;
  const Eigen::MatrixXd u = state.serving->respond(state.forces_on_standing(loads, own), errors);
  std::vector<Response> responses(loads.size());
  for (std::size_t i = 0; i < loads.size(); ++i) {
    responses[i].displacements =
        node_displacements(*state.system, u.col(static_cast<Eigen::Index>(i)), own[i].held_displacement);
    responses[i].fixed_end = fixed_end_of(loads[i], own[i]);
    responses[i].backward_error = errors[i];
  }
  return responses;
}

std::vector<Reanalysis::Response> Reanalysis::respond_near(std::span<const LoadSet> loads,
                                                           std::vector<char>& known) const {
  const State& state = *state_;
  if (loads.empty()) return {};
  std::vector<LoadVector> own;
  std::vector<char> equation_known;
  std::vector<int> ends;
  for (const LoadSet& set : loads)
    for (const BeamLoad& load : set.beams)
      for (const int node : model().beams[static_cast<std::size_t>(load.beam)].node) ends.push_back(node);
  const Eigen::MatrixXd u = state.serving->respond_on_paths(state.forces_on_standing(loads, own), ends, equation_known);
  const DofMap& dofs = state.system->dofs();
  known.assign(state.system->model.nodes.size(), 1);
  for (std::size_t n = 0; n < known.size(); ++n)
    for (const int number : dofs.number[n])
      if (number < dofs.equations && equation_known[static_cast<std::size_t>(number)] == 0) known[n] = 0;
  std::vector<Response> responses(loads.size());
  for (std::size_t i = 0; i < loads.size(); ++i) {
    responses[i].displacements =
        node_displacements(*state.system, u.col(static_cast<Eigen::Index>(i)), own[i].held_displacement);
    responses[i].fixed_end = fixed_end_of(loads[i], own[i]);
    for (std::size_t n = 0; n < known.size(); ++n)
      if (known[n] == 0) responses[i].displacements[n].setZero();
  }
  return responses;
}

Vec12 Reanalysis::beam_stiffness_diagonal(int beam) const {
  return CondensedBeam(state_->system->model.beams[checked_beam(model(), beam)]).stiffness().diagonal();
}

Vec12 Reanalysis::beam_end_forces(int beam, const Response& response) const {
  const std::size_t i = checked_beam(model(), beam);
  const auto fixed = std::lower_bound(response.fixed_end.begin(), response.fixed_end.end(), beam,
                                      [](const auto& one, int wanted) { return one.first < wanted; });
  const bool loaded = fixed != response.fixed_end.end() && fixed->first == beam;
  return state_->end_forces(i, response.displacements, loaded ? fixed->second : Vec12::Zero());
}

Vec3 Reanalysis::point_displacement(int beam, double distance, const std::vector<Vec6>& node_displacements,
                                    std::span<const BeamLoad> own) const {
  const std::size_t i = checked_beam(model(), beam);
  const FrameSystem& system = *state_->system;
  const Beam& b = system.model.beams[i];
  const Vec12 rigid_ends = rigid_end_displacements(b, node_displacements[static_cast<std::size_t>(b.node[0])],
                                                   node_displacements[static_cast<std::size_t>(b.node[1])]);
  const Vec12 forces = system.end_forces(beam, node_displacements, system.fixed_end_forces(beam, own).force);
  const Vec6 local = BeamDiagram(b, forces, own, system.beam_factor[i]).displacement(distance, rigid_ends);
  return b.axes.transpose() * local.head<3>();
}

const ReanalysisCounters& Reanalysis::counters() const { return state_->work.counters; }
const FrameModel& Reanalysis::model() const { return state_->system->model; }
const SelectiveEffort& Reanalysis::selective_effort() const { return state_->effort; }
double Reanalysis::last_operations() const { return state_->work.operations; }

}  // namespace topple::solver
