#include "topple/solver/frame_dynamics.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>
#include <string>

#include "assembly/checked_index.h"
#include "assembly/mass_matrix.h"
#include "assembly/scaled_equations.h"
#include "dynamics/dynamic_state.h"
#include "dynamics/following_factor.h"
#include "dynamics/jumps.h"
#include "dynamics/shorter_substeps.h"

namespace topple::solver {
namespace {

const MassModel& checked(const MassModel& masses) {
  if (masses.distribution != MassDistribution::consistent)
    throw std::invalid_argument("a frame that moves needs consistent mass");
  if (!masses.jointed.empty())
    throw std::invalid_argument("a frame that moves takes no shells that hang on joints that give");
  return masses;
}

std::vector<double> wave_times_of(const FrameModel& model, const std::vector<double>& given) {
  if (!given.empty() && given.size() != model.beams.size())
    throw std::invalid_argument("wave times: one for each beam, or none");
  if (!given.empty()) return given;
  std::vector<double> times;
  for (const Beam& beam : model.beams) times.push_back(beam.length * std::sqrt(beam.density / beam.youngs_modulus));
  return times;
}

std::vector<Vec6> times_of_beams(const FrameModel& model, bool wanted) {
  std::vector<Vec6> times;
  if (wanted) std::transform(model.beams.begin(), model.beams.end(), std::back_inserter(times), times_to_feel);
  return times;
}

}  // namespace

RayleighDamping rayleigh_damping(double ratio, double first, double second) {
  if (!(ratio >= 0) || !std::isfinite(ratio)) throw std::invalid_argument("a damping ratio must be 0 or more");
  if (!(first > 0 && second > 0)) throw std::invalid_argument("damping is given at two frequencies above 0");
  return {2 * ratio * first * second / (first + second), 2 * ratio / (first + second)};
}

FrameDynamics::State::State(FrameModel model, MassModel masses, DynamicOptions given)
    : options(std::move(given)),
      whole(options.substep, options.spectral_radius, options.damping.stiffness),
      method(whole),
      inertia{checked(masses), masses_at_nodes(model, masses), whole.s},
      frame(std::move(model), options.analysis),
      recent_loads(times_of_beams(frame.model(), options.beams_vibrate)),
      started_at(frame.model().nodes.size(), Vec6::Zero()),
      nodes(frame.model().nodes.size()),
      jumps(std::make_unique<Jumps>(options.analysis, damped_in_impulse())),
      shorter(std::make_unique<ShorterSubsteps>(options.analysis)) {
  options.wave_times = wave_times_of(frame.model(), options.wave_times);
  if (!(options.damping.mass >= 0)) throw std::invalid_argument("damping must not be negative");
  if (!(options.shortest_impulse >= 0) || !std::isfinite(options.shortest_impulse))
    throw std::invalid_argument("an impulse must last for 0 s or longer");
  if (!(options.largest_error > 0)) throw std::invalid_argument("the largest error of a substep must be above 0");
  if (options.most_parts < 1) throw std::invalid_argument("a substep has one part or more");
  core().system->inertia = &inertia;
  core().factor_when_asked = true;
}

void FrameDynamics::State::require_undivided() const {
  if (options.most_parts > 1)
    throw std::invalid_argument("loads that go with time act on frames whose substeps are not divided");
}

FrameDynamics::FrameDynamics(FrameModel model, MassModel masses, DynamicOptions options)
    : state_(std::make_unique<State>(std::move(model), std::move(masses), std::move(options))) {
  state_->begin_changed();
}
FrameDynamics::State::~State() = default;
FrameDynamics::~FrameDynamics() = default;
FrameDynamics::FrameDynamics(FrameDynamics&&) noexcept = default;
FrameDynamics& FrameDynamics::operator=(FrameDynamics&&) noexcept = default;

void FrameDynamics::set_end_stiffness(int beam, int end, const Vec6& stiffness) {
  state_->frame.set_end_stiffness(beam, end, stiffness);
  state_->recent_loads.hold_otherwise(beam, state_->held(beam));
}
void FrameDynamics::remove_beam(int beam) { state_->frame.remove_beam(beam); }
void FrameDynamics::remove_shell(int shell) { state_->frame.remove_shell(shell); }
void FrameDynamics::set_patch_stiffness(int patch, Eigen::MatrixXd stiffness) {
  state_->frame.set_patch_stiffness(patch, std::move(stiffness));
}
void FrameDynamics::set_patch_mass(int patch, Eigen::MatrixXd mass) {
  const Patch& own = model().patches[checked_patch(model(), patch)];
  if (mass.rows() != own.stiffness.rows() || mass.cols() != own.stiffness.cols() || !mass.allFinite())
    throw std::invalid_argument("mass of patch " + std::to_string(patch) + " is not a finite matrix of its size");
  state_->core().changes.set_patch_mass(patch, std::move(mass));
}
void FrameDynamics::set_beam_stiffness_factor(int beam, double factor) {
  state_->frame.set_beam_stiffness_factor(beam, factor);
}
void FrameDynamics::set_shell_stiffness(int shell, const Eigen::Matrix<double, 24, 24>& stiffness) {
  state_->frame.set_shell_stiffness(shell, stiffness);
}
void FrameDynamics::set_beam_density(int beam, double density) {
  if (!(density >= 0)) throw std::invalid_argument("a density must not be negative");
  state_->core().changes.set_beam_density(checked_beam(model(), beam), density);
}
void FrameDynamics::set_support_stiffness(int support, const Vec6& stiffness) {
  state_->frame.set_support_stiffness(support, stiffness);
}
void FrameDynamics::drop_nodes(std::span<const int> nodes) { state_->frame.drop_nodes(nodes); }
void FrameDynamics::set_node_load(int node, const Vec6& load) { state_->frame.set_node_load(node, load); }
void FrameDynamics::set_beam_loads(int beam, std::vector<BeamLoad> loads) {
  State& state = *state_;
  const std::size_t i = checked_beam(model(), beam);
  state.recent_loads.change(beam, state.held(beam), state.core().changes.beam(i).loads, loads, state.method.h);
  state.frame.set_beam_loads(beam, std::move(loads));
}

void FrameDynamics::set_plastic_rotation(int beam, int end, int component, double rotation) {
  State& state = *state_;
  (void)checked_beam(model(), beam);
  if (end < 0 || end > 1) throw std::invalid_argument("a beam has end 0 and end 1, not " + std::to_string(end));
  if (component < 3 || component > 5)
    throw std::invalid_argument("a plastic rotation is component 3 to 5, not " + std::to_string(component));
  if (!std::isfinite(rotation)) throw std::invalid_argument("a plastic rotation must be finite");
  state.begin_changed();
  PlasticKinks& kinks = state.kinks;
  kinks.set(state.system(), kinks.number(model(), beam, static_cast<std::size_t>(end), component), rotation);
  state.stored_energy();
}

void FrameDynamics::turn_at_once(int beam, int end, int component, double turn, double dissipated) {
  State& state = *state_;
  const Eigen::Index place = 6 * end + component;
  const double turned = plastic_rotations(beam)(place);
  set_plastic_rotation(beam, end, component, turned);  // what changed before is taken over, and nothing else
  const double before = state.stored_energy();
  set_plastic_rotation(beam, end, component, turned + turn);
  const double by_loads = state.fixed_end_of_loads(static_cast<std::size_t>(beam), true)(place) * turn;
  DynamicEnergy& energy = state.ledger.terms();
  energy.dissipated += dissipated;
  energy.external_work += by_loads;
  energy.struck += state.stored_energy() - before + dissipated - by_loads;
  state.forget_motion();
}

Vec12 FrameDynamics::plastic_rotations(int beam) const { return state_->kinks.rotations(checked_beam(model(), beam)); }

void FrameDynamics::set_mass_damping(double a0) {
  if (!(a0 >= 0)) throw std::invalid_argument("damping must not be negative");
  state_->options.damping.mass = a0;
}

void FrameDynamics::set_damping(const RayleighDamping& damping) {
  if (!(damping.mass >= 0 && damping.stiffness >= 0) || !std::isfinite(damping.mass + damping.stiffness))
    throw std::invalid_argument("damping must be finite, and not negative");
  State& state = *state_;
  state.options.damping.mass = damping.mass;
  if (damping.stiffness == state.options.damping.stiffness) return;
  state.begin_changed();
  state.options.damping.stiffness = damping.stiffness;
  state.set_method({state.whole.h, state.options.spectral_radius, damping.stiffness});
}

void FrameDynamics::set_state(const std::vector<Vec6>& displacements, const std::vector<Vec6>& velocities) {
  State& state = *state_;
  const std::size_t count = state.frame.model().nodes.size();
  if (displacements.size() != count || velocities.size() != count)
    throw std::invalid_argument("a state has six displacements and six velocities for each node");
  state.begin_changed();
  state.started_at = displacements;
  state.kinks.start_here();
  state.before.u = scaled_displacements(state.system(), displacements);
  state.before.v = scaled_displacements(state.system(), velocities);
  state.before.a.setZero(state.equations());
  state.clear_dropped();
  state.now = state.before;
  state.forget_motion();
  state.accepted = true;
  state.stored_energy();
}

int FrameDynamics::add_pattern(const LoadSet& loads) {
  state_->require_undivided();
  if (!loads.shells.empty() || !loads.settlements.empty())
    throw std::invalid_argument("loads that go with time act on nodes and beams");
  return state_->patterns.add(loads);
}

int FrameDynamics::add_ground_acceleration(const Vec3& direction) {
  state_->require_undivided();
  return state_->patterns.add_ground(direction);
}

int FrameDynamics::add_holding_force() {
  State& state = *state_;
  state.require_undivided();
  state.begin_changed();
  SideBySide<1> u = state.current().u.transpose(), Au, Mu;
  multiply<1>(state.system().matrix(), u, Au);
  multiply<1>(state.system().mass(), u, Mu);
  Eigen::VectorXd force = (Au.row(0) - state.inertia.factor * Mu.row(0)).transpose() - state.constant_load;
  state.kinks.subtract(force);
  if (state.options.second_order) {
    state.evaluate_nodes();
    force -= state.find_geometric_load(state.nodes.end().u, true);
  }
  return state.patterns.add_holding(state.system(), std::move(force));
}

void FrameDynamics::set_pattern(int pattern, double value_at_end) { state_->patterns.set(pattern, value_at_end); }
void FrameDynamics::jump_pattern(int pattern, double value) { state_->patterns.jump(pattern, value); }

const std::vector<JointBreak>& FrameDynamics::advance(const JointLaw* law) {
  State& state = *state_;
  state.divide_substep(1);
  if (!state.waiting.empty()) strike({});
  state.begin_changed();
  require_none(state.core().renew_factor());
  ++state.counters.substeps;
  if (law == nullptr || state.options.most_parts == 1) {
    state.patterns.find(state.system());
    state.advance_substep(law);
    state.break_all(law);
  } else {
    state.advance_as_needed(*law);
  }
  return state.breaks;
}

double FrameDynamics::time() const { return state_->time; }
double FrameDynamics::substep() const { return state_->whole.h; }
const std::vector<Vec6>& FrameDynamics::displacements() const {
  state_->evaluate_end();
  return state_->nodes.end().u;
}
const std::vector<Vec6>& FrameDynamics::velocities() const {
  state_->evaluate_nodes();
  return state_->nodes.end().v;
}
const std::vector<Vec6>& FrameDynamics::foresee() {
  if (state_->foreseen.empty()) {
    state_->divide_substep(1);
    strike({});
    require_none(state_->core().renew_factor());
    state_->foresee();
  }
  return state_->foreseen;
}
std::vector<Vec6> FrameDynamics::accelerations() const {
  std::vector<Vec6> result(state_->frame.model().nodes.size());
  state_->system().node_displacements_of_scaled(state_->current().a, result);
  return result;
}

SubstepCourse<Vec6> FrameDynamics::node_course(int node) const {
  state_->evaluate_nodes();
  const auto n = static_cast<std::size_t>(node);
  const NodeMotion &start = state_->nodes.start(), &end = state_->nodes.end();
  return {start.u.at(n), start.v.at(n), end.u.at(n), end.v.at(n), state_->method.h};
}

Vec12 FrameDynamics::beam_end_forces(int beam) const {
  (void)checked_beam(model(), beam);
  state_->evaluate_end();
  return state_->end_forces(beam, true);
}

SubstepCourse<Vec12> FrameDynamics::beam_course(int beam) const {
  (void)checked_beam(model(), beam);
  state_->evaluate_nodes();
  return state_->course(beam);
}

Vec12 FrameDynamics::beam_end_force_rates(int beam) const {
  (void)checked_beam(model(), beam);
  state_->evaluate_nodes();
  return state_->end_force_rates(beam, true);
}

std::array<Vec6, 4> FrameDynamics::shell_corner_forces(int shell, bool rates) const {
  (void)checked_shell(model(), shell);
  state_->evaluate_nodes();
  return state_->system().corner_forces(shell, rates ? state_->nodes.end().v : state_->nodes.end().u, Vec24::Zero());
}

Vec6 FrameDynamics::reaction(int support) const {
  State& state = *state_;
  const std::size_t i = checked_support(model(), support);
  state.evaluate_end();
  if (state.reactions.empty()) {
    const std::vector<Vec6>& u = state.nodes.end().u;
    state.reactions = state.core().reactions_of(
        u, [&](int beam) { return state.end_forces(beam, true); },
        [&](int shell) { return state.system().corner_forces(shell, u, Vec24::Zero()); });
  }
  return state.reactions[i];
}

Vec6 FrameDynamics::momentum() const {
  const State& state = *state_;
  const MassMatrix directions(state.system(), MassModel());
  SideBySide<1> v = state.current().v.transpose(), product;
  multiply<1>(state.system().mass(), v, product);
  Vec6 result;
  for (int c = 0; c < 6; ++c) result(c) = product.row(0).dot(directions.rigid_motion(c, Vec3::Zero()).transpose());
  return result;
}

const DynamicEnergy& FrameDynamics::energy() const { return state_->ledger.terms(); }
double FrameDynamics::work_of_present_loads() {
  State& state = *state_;
  state.begin_changed();
  double work = state.constant_load.dot(state.current().u - scaled_displacements(state.system(), state.started_at));
  state.kinks.add_work([&](std::size_t beam) { return state.core().load.fixed_end(beam); }, work);
  return work;
}
double FrameDynamics::mass_damping() const { return state_->options.damping.mass; }

double FrameDynamics::rayleigh_quotient(const std::vector<Vec6>& displacements) const {
  const State& state = *state_;
  const SideBySide<1> u = scaled_displacements(state.system(), displacements).transpose();
  SideBySide<1> Au, Mu;
  multiply<1>(state.system().matrix(), u, Au);
  multiply<1>(state.system().mass(), u, Mu);
  const double mass = u.row(0).dot(Mu.row(0));
  return mass > 0 ? std::max(0.0, u.row(0).dot(Au.row(0)) / mass - state.inertia.factor) : 0;
}

const FrameModel& FrameDynamics::model() const { return state_->frame.model(); }
const DynamicCounters& FrameDynamics::counters() const { return state_->counters; }
const ReanalysisCounters& FrameDynamics::reanalysis_counters() const { return state_->core().work.counters; }

}  // namespace topple::solver
