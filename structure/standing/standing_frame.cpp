#include "topple/structure/standing_frame.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "failure/panel_demand.h"
#include "loads/placed_load.h"
#include "model/index_of.h"
#include "standing/shell_reading.h"
#include "standing/standing_state.h"
#include "standing/unstable_model.h"
#include "topple/structure/error.h"

namespace topple::structure {

namespace {

/// The combination's loads; a settlement would have to be held through every change and is refused.
PartLoads loads_to_stand(const Building& building, CombinationId combination) {
  PartLoads loads = part_loads(building, combination);
  if (loads.settlements.empty()) return loads;
  const Node& node = building.nodes[static_cast<std::size_t>(loads.settlements.front().node)];
  throw InputError(building.file + ": combinations." + building[combination].name + ": settles node " + node.name +
                   "; demolition takes combinations without settlements");
}

}  // namespace

StandingFrame::State::State(const Building& given, CombinationId combination, const FailureRules& failure,
                            int given_threads)
    : building(given),
      rules(failure),
      threads(given_threads),
      parts(given),
      shells(given),
      loads(given, loads_to_stand(given, combination), parts.bearings, shells),
      edge_loads(given, parts.bearings, loads),
      statics(given, shells, threads),
      components(given, statics),
      joints(given, failure.sudden),
      node_solved(given.nodes.size(), 1),
      applied(given.members.size()),
      node_applied(given.nodes.size(), Vec6::Zero()),
      account({given, parts.segments, parts.bearings, loads, statics, node_solved, applied}),
      yielding({parts, components, loads, applied, node_solved, statics, joints, account, failure.sudden, generation,
                [this] { bring_up_to_date(); }}),
      response({parts, shells, loads, statics, joints, components, node_solved}),
      contacts(response, loads),
      to_check(components.joints.size(), 1),
      demands_behind(components.joints.size(), 0),
      solved_nodes(components.joints.size(), 0),
      in_mechanism(given.members.size(), 0) {
  if (rules.bracing == BracingRule::classic) bracing.emplace(building);
  if (rules.bracing == BracingRule::buckling)
    buckling.emplace(building, statics, parts.segments, parts.bearings, applied, node_applied, node_solved);
  if (rules.second_order) statics.use_second_order();
  for (std::size_t n = 0; n < building.nodes.size(); ++n)
    ++solved_nodes[static_cast<std::size_t>(statics.component(NodeId(n)))];
  if (const auto floating = parts.segments.take_unanchored(); !floating.empty()) {
    FrameMechanism mechanism;
    mechanism.nodes = floating.front().nodes;
    mechanism.motion.assign(building.nodes.size(), Vec6::Zero());
    for (NodeId node : mechanism.nodes) mechanism.motion[index_of(node)](2) = -1;
    throw UnstableModel(describe_mechanism(building, mechanism) + "; nothing connects them to a support");
  }
  write_loads();
  for (int c = 0; c < statics.components(); ++c) {
    if (const auto mechanism = statics.solve(c)) throw UnstableModel(describe_mechanism(building, *mechanism));
    read_demands(c, true);
    yielding.rest(c);
    if (!buckling) continue;
    if (const std::optional<BuckledPost> post = buckling->find(c, statics.diverged(c)))
      throw UnstableModel(building.file + ": post " + (post->post.valid() ? building[post->post].name : "") +
                          " buckles under combination " + building[combination].name + ": the critical factor is " +
                          std::to_string(post->factor));
  }
  account.start();
  // Nothing broke to get here: this state is R0. Joints over capacity break in the first generation.
  pending = !next_generation().empty();
}

bool StandingFrame::State::stands(const ContactPlace& place) const {
  if (place.node.valid()) return stands(place.node) && node_solved[index_of(place.node)] != 0;
  return place.member.valid() ? stands(place.member) : place.panel.valid() && stands(place.panel);
}

Vec6 StandingFrame::State::demand(JointId joint) const {
  if (!parts.standing(joint)) return Vec6::Zero();
  const Joint& own = building[joint];
  if (own.capacity.breakable) return joints.demand(joint);
  return solved_demand(joint);
}

Vec6 StandingFrame::State::solved_demand(JointId joint) const {
  const Joint& own = building[joint];
  if (own.member.valid()) return member_joint_demand(statics.end_forces(own.member), own.end);
  return edge_demands(own.panel)[static_cast<std::size_t>(own.end)];
}

std::array<Vec6, 4> StandingFrame::State::edge_demands(PanelId panel, bool in_motion) const {
  if (!parts.bearings.serves(panel))
    return shell_edge_demands(
        *shells.of(panel), parts.bearings, panel,
        in_motion ? node_displacements(building[panel], *motion) : node_displacements(building[panel], statics),
        loading(panel));
  return panel_edge_demands(
      building, parts.bearings, loads, panel,
      parts.bearings.membrane(panel) ? std::optional(statics.corner_forces(panel)) : std::nullopt);
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
  const bool moves = state.moves(state.statics.component(node)) && state.node_solved[index_of(node)] != 0;
  return moves ? state.motion->displacement(node) : state.account.displacement(node);
}
Vec6 StandingFrame::demand(JointId joint) const {
  state_->know_demands();
  return state_->demand(joint);
}
double StandingFrame::largest_utilisation_so_far(JointId joint) const {
  state_->know_demands();
  return state_->joints.largest(joint);
}
std::optional<PanelStress> StandingFrame::stress(PanelId panel) const { return state_->stress(panel); }
double StandingFrame::elastic_energy() const { return energy().elastic; }
double StandingFrame::mass(MemberId member) const { return state_->loads.mass(member); }
double StandingFrame::mass(PanelId panel) const { return state_->loads.mass(panel); }
double StandingFrame::node_mass(NodeId node) const { return state_->loads.mass(node); }
const Building& StandingFrame::building() const { return state_->building; }

Utilisation StandingFrame::utilisation(JointId joint) const {
  state_->know_demands();
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
  if (!state_->node_solved[index_of(node)]) return sum;
  const auto& supports = state_->building.supports;
  for (std::size_t s = 0; s < supports.size(); ++s)
    if (supports[s].node == node) sum += state_->statics.reaction(s);
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
  state_->queue.push_back(State::BreakJoint{joint, cause});
  state_->pending = true;
}
void StandingFrame::remove(MemberId member) {
  state_->queue.push_back(member);
  state_->pending = true;
}
void StandingFrame::remove(PanelId panel) {
  state_->queue.push_back(panel);
  state_->pending = true;
}
void StandingFrame::remove_support(NodeId node) {
  state_->queue.push_back(State::RemoveSupport{node});
  state_->pending = true;
}
void StandingFrame::set_gravity(const Vec3& gravity) {
  state_->queue.push_back(State::Gravity{gravity});
  state_->pending = true;
}
void StandingFrame::add_load(NodeId node, const Vec6& load) {
  state_->queue.push_back(State::EventLoad{node, load});
  state_->pending = true;
}

void StandingFrame::set_strength_factor(JointId joint, double factor) {
  State& state = *state_;
  if (!state.building[joint].capacity.breakable || state.joints.strength(joint) == factor) return;
  if (!(factor > 0)) return break_joint(joint, BreakCause::tool);
  state.joints.set_strength(joint, factor);
  state.statics.forget_uses(state.components.of(joint));
  state.to_check[static_cast<std::size_t>(state.components.of(joint))] = 1;
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
  state.softened = state.pending = true;
}

void StandingFrame::set_contact_load(const ContactLoad& load) {
  if (state_->stands(load.place) && state_->contacts.set(load)) state_->pending = true;
}

void StandingFrame::remove_contact_load(std::int64_t key) {
  if (state_->contacts.remove(key)) state_->pending = true;
}

void StandingFrame::restrict_answers_from(int nodes) { state_->selective_from = nodes; }

bool StandingFrame::pending() const { return state_->pending; }

std::vector<JointBreak> StandingFrame::settle(int generations) {
  State& state = *state_;
  if (state.motion) throw std::logic_error("what moves does not settle: move()");
  if (!state.pending) {
    ++state.idle_settles;
    return {};
  }
  state.generation = 0;
  state.settle(generations);
  state.generation = 0;
  state.account.lines_are_out();
  return std::exchange(state.breaks, {});
}

void StandingFrame::State::settle(int generations) {
  lay_contacts();
  if (!queue.empty()) know_demands();  // of what a tool breaks
  for (const Change& change : std::exchange(queue, {})) apply(change);
  bring_up_to_date();
  for (;;) {
    const std::vector<JointId> next = next_generation();
    pending = !next.empty() || !buckled.empty();
    if (!pending) return;
    if (generation == generations) {
      buckled.clear();  // found again
      return;
    }
    break_joints(next, BreakCause::overload);
    snap_buckled();
    bring_up_to_date();
    ++generation;
  }
}

std::vector<JointBreak> StandingFrame::take_yielded() { return state_->yielding.take_yielded(); }
bool StandingFrame::has_detached() const { return !state_->detached.empty(); }
std::vector<Detached> StandingFrame::take_detached() { return std::exchange(state_->detached, {}); }

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
  state_->know_demands();
  return state_->response.critical_energy(state_->components.of(place));
}

double StandingFrame::break_in_impact(std::span<const JointBreak> breaks, const ContactPlace& place,
                                      const Vec3& direction) {
  return break_in_impact(breaks, std::span(&place, 1), std::span(&direction, 1))(0);
}

Eigen::VectorXd StandingFrame::break_in_impact(std::span<const JointBreak> breaks, std::span<const ContactPlace> places,
                                               std::span<const Vec3> directions) {
  State& state = *state_;
  state.lay_contacts();
  Eigen::VectorXd shift(static_cast<Eigen::Index>(places.size()));
  for (std::size_t i = 0; i < places.size(); ++i)
    shift(static_cast<Eigen::Index>(i)) =
        state.stands(places[i]) ? state.response.displacement_along(places[i], directions[i]) : 0.0;
  std::vector<JointId> broken;
  for (const JointBreak& one : breaks) broken.push_back(one.joint);
  state.break_joints(broken, BreakCause::impact);
  state.bring_up_to_date();
  state.account.lines_are_out();
  // The caller knows its own breaks; what they brought with them is told by the next settle().
  std::erase_if(state.breaks, [](const JointBreak& one) { return one.cause == BreakCause::impact; });
  state.pending = true;
  for (std::size_t i = 0; i < places.size(); ++i) {
    double& by = shift(static_cast<Eigen::Index>(i));
    by = state.stands(places[i]) ? state.response.displacement_along(places[i], directions[i]) - by : 0.0;
  }
  return shift;
}

void StandingFrame::expect_fracture(PanelId panel) {
  if (state_->parts.bearings.membrane(panel)) state_->shells.know(panel);
}

void StandingFrame::fracture(PanelId panel, const PanelRemains& remains) {
  State& state = *state_;
  if (!state.stands(panel)) return;
  state.fracture(panel, remains);
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
