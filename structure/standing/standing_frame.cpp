#include "topple/structure/standing_frame.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "model/index_of.h"
#include "standing/standing_state.h"

namespace topple::structure {

StandingFrame::State::State(const Building& given, CombinationId of_loads, const FailureRules& failure,
                            int given_threads)
    : StructuralState(given, of_loads, failure, given_threads),
      breaks(parts, joints),
      yielding({parts, components, loads, in_solver.member_loads(), in_solver.held_nodes(), statics, joints, account,
                failure.sudden, breaks.generation(), [this] { generations.bring_up_to_date(); }}),
      answers(*this, yielding),
      slow(*this, answers, yielding, breaks),
      departures(*this),
      shell_damage(*this, departures),
      damage({*this, yielding, breaks, slow, departures, shell_damage}),
      release({*this, yielding, breaks, departures, shell_damage, damage}),
      generations({*this, yielding, breaks, answers, damage, release}),
      queue(*this, damage) {
  pending = generations.start();
}

StandingFrame::StandingFrame(const Building& building, CombinationId combination, const FailureRules& rules,
                             int threads)
    : state_(std::make_unique<State>(building, combination, rules, threads)) {}
StandingFrame::~StandingFrame() = default;

bool StandingFrame::stands(MemberId member) const { return state_->stands(member); }
bool StandingFrame::stands(PanelId panel) const { return state_->stands(panel); }
bool StandingFrame::stands(NodeId node) const { return state_->stands(node); }
bool StandingFrame::intact(JointId joint) const { return state_->parts.holds(joint); }
const Vec6& StandingFrame::displacement(NodeId node) const {
  const State& state = *state_;
  const bool moves = state.moves(state.statics.component(node)) && state.in_solver.holds(node);
  return moves ? state.motion->displacement(node) : state.account.displacement(node);
}
Vec6 StandingFrame::demand(JointId joint) const {
  state_->answers.evaluate_demands();
  return state_->answers.demand(joint);
}
double StandingFrame::largest_utilisation_so_far(JointId joint) const {
  state_->answers.evaluate_demands();
  return state_->joints.largest(joint);
}
double StandingFrame::elastic_energy() const { return energy().elastic; }
double StandingFrame::mass(MemberId member) const { return state_->loads.mass(member); }
double StandingFrame::mass(PanelId panel) const { return state_->loads.mass(panel); }
double StandingFrame::node_mass(NodeId node) const { return state_->loads.mass(node); }
const Building& StandingFrame::building() const { return state_->building; }

Utilisation StandingFrame::utilisation(JointId joint) const {
  state_->answers.evaluate_demands();
  const bool counts = state_->building[joint].capacity.breakable && state_->parts.standing(joint);
  return counts ? state_->joints.utilisation(joint) : Utilisation{};
}

Eigen::Matrix<double, 12, 1> StandingFrame::end_forces(MemberId member) const {
  if (!state_->stands(member)) return Eigen::Matrix<double, 12, 1>::Zero();
  if (state_->moves(state_->statics.component(member))) return state_->motion->end_forces(member);
  return state_->statics.end_forces(member);
}

Vec6 StandingFrame::reaction(NodeId node) const {
  Vec6 sum = Vec6::Zero();
  if (!state_->in_solver.holds(node)) return sum;
  const auto& supports = state_->building.supports;
  for (std::size_t s = 0; s < supports.size(); ++s)
    if (supports[s].node == node) sum += reaction(s);
  return sum;
}

int StandingFrame::segment(MemberId member) const { return state_->parts.segment(member); }

int StandingFrame::standing_segments() const { return state_->parts.segment_count(); }

double StandingFrame::roof_sag() const {
  const std::vector<Node>& nodes = state_->building.nodes;
  double top = -unlimited, low = unlimited;
  for (const Node& node : nodes) {
    top = std::max(top, node.position.z());
    low = std::min(low, node.position.z());
  }
  const double same_height = 1e-9 * std::max(top - low, 1.0);
  double sum = 0;
  int count = 0;
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    if (nodes[n].position.z() < top - same_height || !state_->stands(NodeId(n))) continue;
    sum -= displacement(NodeId(n))(2);
    ++count;
  }
  return count > 0 ? sum / count : 0;
}

void StandingFrame::break_joint(JointId joint, BreakCause cause) {
  state_->queue.add(QueuedChanges::BreakJoint{joint, cause});
  state_->pending = true;
}
void StandingFrame::remove(MemberId member) {
  state_->queue.add(member);
  state_->pending = true;
}
void StandingFrame::remove(PanelId panel) {
  state_->queue.add(panel);
  state_->pending = true;
}
void StandingFrame::remove_support(NodeId node) {
  state_->queue.add(QueuedChanges::RemoveSupport{node});
  state_->pending = true;
}
void StandingFrame::set_gravity(const Vec3& gravity) {
  state_->queue.add(QueuedChanges::Gravity{gravity});
  state_->pending = true;
}
void StandingFrame::add_load(NodeId node, const Vec6& load) {
  state_->queue.add(QueuedChanges::EventLoad{node, load});
  state_->pending = true;
}

void StandingFrame::set_strength_factor(JointId joint, double factor) {
  State& state = *state_;
  if (!state.building[joint].capacity.breakable || state.joints.strength(joint) == factor) return;
  if (!(factor > 0)) return break_joint(joint, BreakCause::tool);
  state.joints.set_strength(joint, factor);
  state.statics.forget_utilisations(state.components.of(joint));
  state.check_again(state.components.of(joint));
  state.response.forget_bounds(state.components.of(joint));
  state.pending = true;
}

void StandingFrame::set_stiffness_factor(MemberId member, double factor) {
  if (!(factor > 0 && factor <= 1)) throw std::invalid_argument("a stiffness factor must be above 0 and at most 1");
  State& state = *state_;
  if (!state.stands(member) || state.statics.stiffness(member) == factor) return;
  state.account.change(member).soften(member);
  state.slowly = true;
  state.statics.set_stiffness(member, factor);
  state.slowly = false;
  state.slow.soften();
  state.pending = true;
}

void StandingFrame::set_contact_load(const ContactLoad& load) {
  if (state_->stands(load.place) && state_->contacts.set(load)) state_->pending = true;
}

void StandingFrame::remove_contact_load(std::int64_t key) {
  if (state_->contacts.remove(key)) state_->pending = true;
}

void StandingFrame::restrict_answers_from(int nodes) { state_->answers.restrict_from(nodes); }

bool StandingFrame::pending() const { return state_->pending; }

std::vector<JointBreak> StandingFrame::settle(int generations) {
  State& state = *state_;
  if (state.motion) throw std::logic_error("what moves does not settle: move()");
  if (!state.pending) {
    ++state.idle_settles;
    return {};
  }
  state.breaks.start_generations();
  state.settle(generations);
  state.breaks.start_generations();
  state.account.lines_are_out();
  return state.breaks.extract();
}

void StandingFrame::State::settle(int most) {
  slow.lay();
  if (!queue.empty()) answers.evaluate_demands();  // of what a tool breaks
  queue.act();
  generations.bring_up_to_date();
  pending = generations.run(most);
}

std::vector<JointBreak> StandingFrame::extract_yielded() { return state_->yielding.extract_yielded(); }
bool StandingFrame::has_detached() const { return state_->departures.any(); }
std::vector<Detached> StandingFrame::extract_detached() { return state_->departures.extract(); }

StandingFrame::UnitResponse StandingFrame::respond(const ContactPlace& place, const Vec3& direction) const {
  return std::move(respond({&place, 1}, {&direction, 1}).places.front());
}

StandingFrame::CoupledResponse StandingFrame::respond(std::span<const ContactPlace> places,
                                                      std::span<const Vec3> directions) const {
  return state_->response.respond(places, directions);
}

StandingFrame::UnitResponse StandingFrame::respond_near(const ContactPlace& place, const Vec3& direction) const {
  return std::move(respond_near({&place, 1}, {&direction, 1}).places.front());
}

StandingFrame::CoupledResponse StandingFrame::respond_near(std::span<const ContactPlace> places,
                                                           std::span<const Vec3> directions) const {
  return state_->response.respond_near(places, directions);
}

double StandingFrame::critical_energy(const ContactPlace& place) const {
  state_->answers.evaluate_demands();
  return state_->response.critical_energy(state_->components.of(place));
}

double StandingFrame::break_in_impact(std::span<const JointBreak> breaks, const ContactPlace& place,
                                      const Vec3& direction) {
  return break_in_impact(breaks, std::span(&place, 1), std::span(&direction, 1))(0);
}

Eigen::VectorXd StandingFrame::break_in_impact(std::span<const JointBreak> breaks, std::span<const ContactPlace> places,
                                               std::span<const Vec3> directions) {
  State& state = *state_;
  state.slow.lay();
  Eigen::VectorXd shift(static_cast<Eigen::Index>(places.size()));
  for (std::size_t i = 0; i < places.size(); ++i)
    shift(static_cast<Eigen::Index>(i)) =
        state.stands(places[i]) ? state.response.displacement_along(places[i], directions[i]) : 0.0;
  std::vector<JointId> broken;
  for (const JointBreak& one : breaks) broken.push_back(one.joint);
  state.damage.break_joints(broken, BreakCause::impact);
  state.generations.bring_up_to_date();
  state.account.lines_are_out();
  // The caller knows its own breaks; what they brought with them is told by the next settle().
  std::erase_if(state.breaks.lines(), [](const JointBreak& one) { return one.cause == BreakCause::impact; });
  state.pending = true;
  for (std::size_t i = 0; i < places.size(); ++i) {
    double& by = shift(static_cast<Eigen::Index>(i));
    by = state.stands(places[i]) ? state.response.displacement_along(places[i], directions[i]) - by : 0.0;
  }
  return shift;
}

void StandingFrame::expect_fracture(PanelId panel) {
  if (state_->parts.bearings.membrane(panel)) state_->shells.add(panel);
}

void StandingFrame::fracture(PanelId panel, const PanelRemains& remains, const std::optional<Vec3>& taken) {
  State& state = *state_;
  if (!state.stands(panel)) return;
  if (taken && state.motion) state.motion->give_to_chunks(panel, *taken);
  state.damage.fracture(panel, remains);
  state.pending = true;
}

Eigen::MatrixXd StandingFrame::shell_stiffness(PanelId shell) const { return state_->shells.of(shell)->stiffness(); }

const FrameCounters& StandingFrame::counters() const {
  FrameCounters& counters = state_->counters;
  const solver::ReanalysisCounters solved = state_->statics.counters();
  counters.solves = solved.solves;
  counters.low_rank = solved.low_rank;
  counters.refactorisations = solved.refactorisations;
  counters.selective = solved.selective;
  counters.background_factors = solved.background_factors;
  counters.late_factors = solved.late_factors;
  counters.unchanged = solved.unchanged + state_->idle_settles;
  counters.segmentations = state_->parts.segments.searches();
  counters.vertices_searched = state_->parts.segments.vertices_searched();
  return counters;
}

}  // namespace topple::structure
