#include "topple/solver/reanalysis.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "elements/beam_energy.h"
#include "reanalysis/reanalysis_state.h"
#include "reanalysis/update_costs.h"
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

Eigen::Matrix<double, 24, 24> Reanalysis::shell_stiffness(int shell) const {
  (void)state_->checked_shell(shell);
  return state_->system->shell_node_stiffness(shell);
}

void Reanalysis::set_shell_stiffness(int shell, const Eigen::Matrix<double, 24, 24>& stiffness) {
  (void)state_->checked_shell(shell);
  if (!stiffness.allFinite())
    throw std::invalid_argument("stiffness of shell " + std::to_string(shell) + " is not finite");
  state_->given_stiffness[shell] = stiffness;
}

void Reanalysis::set_patch_stiffness(int patch, Eigen::MatrixXd stiffness) {
  const Patch& own = model().patches[state_->checked_patch(patch)];
  if (stiffness.rows() != own.stiffness.rows() || stiffness.cols() != own.stiffness.cols() || !stiffness.allFinite())
    throw std::invalid_argument("stiffness of patch " + std::to_string(patch) + " is not a finite matrix of its size");
  state_->given_to_patch[patch] = std::move(stiffness);
}

const Eigen::MatrixXd& Reanalysis::patch_stiffness(int patch) const {
  return model().patches[state_->checked_patch(patch)].stiffness;
}

std::vector<Vec6> Reanalysis::patch_forces(int patch) const {
  (void)state_->checked_patch(patch);
  return state_->system->patch_forces(patch, state_->whole());
}

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
  state_->stale_load_nodes.push_back(node);
}

void Reanalysis::set_beam_loads(int beam, std::vector<BeamLoad> loads) {
  std::vector<BeamLoad>& target = state_->targets[state_->checked_beam(beam)].loads;
  for (BeamLoad& load : loads) load.beam = beam;
  if (same(target, loads)) return;
  target = std::move(loads);
  state_->mark(beam);
}

const std::vector<Vec6>& Reanalysis::displacements() const { return state_->whole(); }

const std::vector<Vec6>& Reanalysis::displacements_at(std::span<const int> nodes) const {
  const State& state = *state_;
  const bool here = !state.selective || std::all_of(nodes.begin(), nodes.end(),
                                                    [&](int node) { return state.selective->node_is_current(node); });
  return here ? state.displacements : state.whole();
}

const BeamStrainForces& Reanalysis::State::strain_forces_of(std::size_t i) const {
  if (strain_forces_known[i] == 0) {
    strain_forces[i] = BeamStrainForces(CondensedBeam(system->model.beams[i], system->beam_factor[i]));
    strain_forces_known[i] = 1;
  }
  return strain_forces[i];
}

Vec12 Reanalysis::State::end_forces(std::size_t i, const std::vector<Vec6>& u, const Vec12& fixed) const {
  if (system->beam_stands[i] == 0) return Vec12::Zero();
  const Beam& beam = system->model.beams[i];
  const Vec12 rigid_ends = rigid_end_displacements(beam, u[static_cast<std::size_t>(beam.node[0])],
                                                   u[static_cast<std::size_t>(beam.node[1])]);
  return strain_forces_of(i)(relative_motion(beam.length, rigid_ends)) + fixed;
}

Vec12 Reanalysis::beam_end_forces(int beam) const {
  const std::size_t i = state_->checked_beam(beam);
  const bool here = !state_->selective || state_->selective->beam_is_current(beam);
  return state_->end_forces(i, here ? state_->displacements : state_->whole(), state_->fixed_end[i]);
}

std::array<Vec6, 4> Reanalysis::shell_corner_forces(int shell) const {
  (void)state_->checked_shell(shell);
  const bool here = !state_->selective || state_->selective->shell_is_current(shell);
  return state_->system->corner_forces(shell, here ? state_->displacements : state_->whole(), Vec24::Zero());
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
    state_->reactions = system.reactions(state_->whole(), forces, corners, state_->node_loads);
  }
  return state_->reactions[static_cast<std::size_t>(support)];
}

double Reanalysis::strain_energy() const {
  const std::vector<Vec6>& displacements = state_->whole();
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

LoadVector Reanalysis::State::force_on_standing(const LoadSet& loads) const {
  if (!answer.stable || !structure_stands)
    throw Instability("the structure does not stand: it has no response", answer.mechanism);
  LoadVector result = system->load_vector(loads);
  system->drop_idle_loads(result);
  if (const auto defect = system->unbalanced_load(result, negligible_lever))
    throw Instability(defect->message, defect->motion);
  return result;
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
  Eigen::MatrixXd forces;
  for (std::size_t i = 0; i < loads.size(); ++i) {
    own.push_back(force_on_standing(loads[i]));
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
  const Eigen::MatrixXd u = state.solve_sparse(state.forces_on_standing(loads, own), errors);
  std::vector<Response> responses(loads.size());
  for (std::size_t i = 0; i < loads.size(); ++i) {
    responses[i].displacements =
        state.system->node_displacements(u.col(static_cast<Eigen::Index>(i)), own[i].held_displacement);
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
  const Eigen::MatrixXd u = state.solve_on_paths(state.forces_on_standing(loads, own), ends, equation_known);
  const DofMap& dofs = state.system->dofs();
  known.assign(state.system->model.nodes.size(), 1);
  for (std::size_t n = 0; n < known.size(); ++n)
    for (const int number : dofs.number[n])
      if (number < dofs.equations && equation_known[static_cast<std::size_t>(number)] == 0) known[n] = 0;
  std::vector<Response> responses(loads.size());
  for (std::size_t i = 0; i < loads.size(); ++i) {
    responses[i].displacements =
        state.system->node_displacements(u.col(static_cast<Eigen::Index>(i)), own[i].held_displacement);
    responses[i].fixed_end = fixed_end_of(loads[i], own[i]);
    for (std::size_t n = 0; n < known.size(); ++n)
      if (known[n] == 0) responses[i].displacements[n].setZero();
  }
  return responses;
}

Vec12 Reanalysis::beam_stiffness_diagonal(int beam) const {
  return CondensedBeam(state_->system->model.beams[state_->checked_beam(beam)]).stiffness().diagonal();
}

Vec12 Reanalysis::beam_end_forces(int beam, const Response& response) const {
  const std::size_t i = state_->checked_beam(beam);
  const auto fixed = std::lower_bound(response.fixed_end.begin(), response.fixed_end.end(), beam,
                                      [](const auto& one, int wanted) { return one.first < wanted; });
  const bool loaded = fixed != response.fixed_end.end() && fixed->first == beam;
  return state_->end_forces(i, response.displacements, loaded ? fixed->second : Vec12::Zero());
}

Vec3 Reanalysis::point_displacement(int beam, double distance, const std::vector<Vec6>& node_displacements,
                                    std::span<const BeamLoad> own) const {
  const std::size_t i = state_->checked_beam(beam);
  const FrameSystem& system = *state_->system;
  const Beam& b = system.model.beams[i];
  const Vec12 rigid_ends = rigid_end_displacements(b, node_displacements[static_cast<std::size_t>(b.node[0])],
                                                   node_displacements[static_cast<std::size_t>(b.node[1])]);
  const Vec12 forces = system.end_forces(beam, node_displacements, system.fixed_end_forces(beam, own).force);
  const Vec6 local = BeamDiagram(b, forces, own, system.beam_factor[i]).displacement(distance, rigid_ends);
  return b.axes.transpose() * local.head<3>();
}

const ReanalysisCounters& Reanalysis::counters() const { return state_->counters; }
const FrameModel& Reanalysis::model() const { return state_->system->model; }
const SelectiveEffort& Reanalysis::selective_effort() const { return state_->effort; }
double Reanalysis::last_operations() const { return state_->operations; }

}  // namespace topple::solver
