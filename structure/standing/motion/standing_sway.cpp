// What stands moves: the step of a frame that is not at rest, from changes to breaks, release and rest.
#include <algorithm>
#include <cmath>
#include <span>

#include "standing/beam_as_it_holds.h"
#include "standing/held_push.h"
#include "standing/standing_state.h"
#include "topple/solver/held_beam.h"
#include "topple/structure/error.h"

namespace topple::structure {

std::optional<std::string> why_it_stays_at_rest(const Building& building) {
  if (!(building.gravity > 0)) return "mass is weight over gravity, and the model has none";
  return std::nullopt;
}

namespace {

MotionSettings settings_of(const MotionRules& rules, double dt) {
  MotionSettings settings = motion_settings;
  settings.spectral_radius = rules.spectral_radius;
  if (rules.damping) settings.metal_damping = settings.other_damping = *rules.damping;
  if (rules.substeps) settings.longest_substep = dt / *rules.substeps;
  return settings;
}

}  // namespace

void StandingFrame::let_move(double dt, const MotionRules& rules) {
  State& state = *state_;
  if (rules.substeps && *rules.substeps < 1) throw std::invalid_argument("a step has at least one substep");
  if (const auto reason = why_it_stays_at_rest(state.building))
    throw InputError(state.building.file + ": what stands cannot move: " + *reason);
  if (state.rules.sudden != 1) throw std::invalid_argument("what moves has no factor of a sudden loss: it must be 1");
  state.make_motion(settings_of(rules, dt));
  state.substeps = state.motion->set_step(dt);
}

void StandingFrame::State::make_motion(const MotionSettings& settings) {
  motion = std::make_unique<StandingMotion>(
      MotionSources{building, parts, loads, statics, joints, yielding, components, shells, account,
                    in_solver.held_nodes(), rules.second_order, threads},
      settings);
  statics.before_changes([this](int c) {
    if (!slowly && in_solver.nodes_of(c) > 0) motion->start(c);
  });
}

std::vector<JointBreak> StandingFrame::move(const std::function<void()>& after_substep) {
  if (state_->motion && !state_->pending) {
    ++state_->idle_settles;
    return {};
  }
  std::vector<JointBreak> breaks = begin_move();
  for (int substep = 0; substep < substeps() && in_motion(); ++substep) move_on(after_substep);
  const std::vector<JointBreak> later = end_move();
  breaks.insert(breaks.end(), later.begin(), later.end());
  return breaks;
}

std::vector<JointBreak> StandingFrame::begin_move() {
  if (!state_->motion) throw std::logic_error("what stands was not let move: let_move()");
  state_->begin_motion();
  return extract_breaks();
}

bool StandingFrame::in_motion() const { return state_->motion && state_->motion->any(); }
int StandingFrame::substeps() const { return state_->substeps; }
void StandingFrame::move_on(const std::function<void()>& after_substep) { state_->move_on(after_substep); }

void StandingFrame::take_changes() {
  if (!in_motion()) return;
  if (state_->loads.changed()) state_->follow_breaks();
  for (const int c : state_->motion->moving()) (void)state_->motion->strike(c, {});
}

std::uint64_t StandingFrame::mobility_changes() const { return state_->motion ? state_->motion->changes() : 0; }

std::vector<JointBreak> StandingFrame::extract_breaks() {
  state_->account.lines_are_out();
  return state_->breaks.extract();
}

void StandingFrame::read_demands() {
  if (!state_->motion) return;
  for (const int c : state_->motion->moving()) state_->read_motion(c);
}

std::vector<JointBreak> StandingFrame::end_move() {
  state_->end_motion();
  return extract_breaks();
}

bool StandingFrame::moves(const ContactPlace& place) const {
  return state_->motion && state_->stands(place) && state_->moves(state_->components.of(place));
}

Vec6 StandingFrame::velocity(NodeId node) const {
  const State& state = *state_;
  const bool moves = state.moves(state.statics.component(node)) && state.in_solver.holds(node);
  return moves ? state.motion->velocity(node) : Vec6(Vec6::Zero());
}

Eigen::Matrix<double, 6, 6> StandingFrame::substep_mobility(NodeId node) const {
  const State& state = *state_;
  const int c = state.statics.component(node);
  if (!state.moves(c) || !state.in_solver.holds(node)) return Eigen::Matrix<double, 6, 6>::Zero();
  std::vector<StandingMotion::NodalForces> units;
  for (int i = 0; i < 6; ++i) units.push_back({{node, Vec6::Unit(i)}});
  return state.motion->substep_mobility(c, units);
}

Vec6 StandingFrame::foreseen_acceleration(NodeId node) {
  State& state = *state_;
  const bool moves = state.moves(state.statics.component(node)) && state.in_solver.holds(node);
  return moves ? state.motion->foreseen_acceleration(node) : Vec6(Vec6::Zero());
}

FrameEnergy StandingFrame::energy() const {
  FrameEnergy energy = state_->account.energy();
  if (!state_->motion) return energy;
  const MotionEnergy moving = state_->motion->energy();
  energy.elastic += moving.elastic_change;
  energy.gravity_work += moving.external_work;
  energy.freed += moving.freed - state_->rested_freed;
  energy.kinetic = moving.kinetic;
  energy.damped = moving.damped;
  energy.numerical = moving.numerical;
  energy.struck = moving.struck;
  energy.dissipated += moving.dissipated;
  return energy;
}

namespace {
bool left_small_displacements(double turn) { return turn > motion_settings.largest_turn; }
}  // namespace

void StandingFrame::State::move_on(const std::function<void()>& after_substep) {
  const std::uint64_t searches = parts.segments.searches();
  if (loads.changed()) follow_breaks();
  for (const int c : motion->moving()) sway(c);
  if (after_substep) {
    after_substep();
    follow_breaks();
  }
  // What it could not leave by before it cannot leave by now, unless something broke.
  for (const int c : motion->moving())
    if (motion->moves(c) &&
        (parts.segments.searches() != searches || !left_small_displacements(motion->last_turn(c))) &&
        left_small_displacements(motion->largest_turn(c)))
      let_mechanisms_go(c);
  breaks.next_generation();
}

void StandingFrame::State::end_motion() {
  for (const int c : motion->moving()) leave_small_displacements(c);
  for (const int c : motion->moving()) {
    check_rest(c);
    if (motion->moves(c)) read_motion(c);
  }
  breaks.start_generations();
  account.lines_are_out();
  pending = motion->any() || !queue.empty();
}

/// Tools, contacts and new capacities act.
void StandingFrame::State::begin_motion() {
  breaks.start_generations();
  if (slow.extract_softened()) soften_at_rest();
  queue.act();
  follow_breaks();
  for (int c = 0; c < statics.components(); ++c) {
    if (!std::exchange(to_check[static_cast<std::size_t>(c)], 0) || motion->moves(c)) continue;
    if (in_solver.nodes_of(c) == 0)
      statics.forget(c);
    else if (!answers.bears(c) || yielding.yields_in_answer(c))
      motion->start(c);
    else
      answers.remember(c);
  }
}

/// A fire is slower than anything that moves: what is at rest goes from one state of rest to the next, as long as it
/// bears that.
void StandingFrame::State::soften_at_rest() {
  for (int c = 0; c < statics.components(); ++c) {
    if (!statics.changed(c) || motion->moves(c) || in_solver.nodes_of(c) == 0) continue;
    slowly = true;  // a state of rest is sought by loads, too
    const bool found = !answers.solve_slow(c);
    slowly = false;
    if (!found) continue;  // factors above 0 make no mechanism of what stood
    account.finish(c, true, breaks.lines());
    check_again(c);
  }
}

/// What lost its hold leaves, and what remains bears its loads.
void StandingFrame::State::follow_breaks() {
  parts.forget_numbers();
  do {
    release.release();
    write_loads();
  } while (damage.leaves_open());
  for (const int c : motion->moving()) {
    if (in_solver.nodes_of(c) > 0) continue;
    motion->stop(c);
    statics.forget(c);
    const double freed = account.freed();
    generations.come_to_rest(c);
    rested_freed += account.freed() - freed;
  }
}

/// One substep of a component.
void StandingFrame::State::sway(int c) {
  if (!motion->moves(c)) return;
  const std::size_t before = breaks.size();
  const std::vector<StandingMotion::Break> broken = motion->advance(c);
  for (const StandingMotion::Break& one : broken) break_in_motion(one.joint, one.demand, one.freed);
  break_edges_over(c);
  if (breaks.size() > before) follow_breaks();
}

void StandingFrame::State::break_in_motion(JointId joint, const Vec6& demand, double freed) {
  if (!parts.standing(joint)) return;
  joints.set_demand(joint, demand);
  breaks.add(joint, BreakCause::overload).energy = freed;
  damage.let_go(joint);
}

/// Edges of panels bear what lies on the panel, and the membrane's traction: looked at after each substep.
void StandingFrame::State::break_edges_over(int c) {
  answers.read_edges_in_motion(c);
  std::vector<JointId> over;
  for (const JointId joint : components.edges[static_cast<std::size_t>(c)])
    if (parts.standing(joint) && joints.check(joint).value > 1) over.push_back(joint);
  for (const JointId joint : over) break_in_motion(joint, joints.demand(joint), 0);
}

/// At the end of a step. What comes to it, or loses a joint, within a substep leaves in that (move_on()).
void StandingFrame::State::leave_small_displacements(int c) {
  const double turn = motion->largest_turn(c);
  motion->damp_by_mass(c, turn);
  if (left_small_displacements(turn)) let_mechanisms_go(c);
}

/// A part that has turned too far for small displacements goes over to the collision world, with its motion, where it
/// can move without strain; a part that cannot stays.
void StandingFrame::State::let_mechanisms_go(int c) {
  while (motion->moves(c)) {
    const std::optional<FrameMechanism> mechanism = statics.solve(c);
    if (!mechanism) return;
    release.cut_free(*mechanism);
    follow_breaks();
  }
}

/// What joints bear now, for whoever asks.
void StandingFrame::State::read_motion(int c) {
  response.forget_bounds(c);
  MemberId member_read;
  solver::Vec12 end_forces;
  for (const JointId joint : components.joints[static_cast<std::size_t>(c)]) {
    const Joint& own = building[joint];
    if (!own.member.valid() || !parts.standing(joint)) continue;
    if (own.member != member_read) end_forces = motion->end_forces(own.member);
    member_read = own.member;
    joints.set_demand(joint, member_joint_demand(end_forces, own.end));
  }
}

/// It is set to its static state, to the bit, once it is near and that state is borne.
void StandingFrame::State::check_rest(int c) {
  if (!motion->check_rest(c)) return;
  yielding.lay_rotations(c);
  if (statics.solve(c)) return;
  motion->update_damping(c);
  if (!motion->rests(c)) return;
  answers.read(c, false);
  if (!answers.bears(c) || yielding.yields_in_answer(c)) return;
  motion->settle(c);
  const double freed = account.freed();
  generations.come_to_rest(c);
  rested_freed += account.freed() - freed;
  generations.snap_what_buckles(c);
}

StandingFrame::PanelMotion StandingFrame::motion(PanelId panel) const {
  const State& state = *state_;
  if (!state.stands(panel) || !state.moves(state.components.of(panel))) return {};
  return {state.motion->momentum().velocity(panel), state.motion->momentum().spin(panel)};
}

}  // namespace topple::structure
