// Break-up: a body that is hit hard is a free segment (free_segment.h). Its joints that are over capacity break, those
// most over first, and it falls apart into parts that move on as the whole did: momentum, linear and angular, and
// kinetic energy go over exactly.
//
// One analysis answers for a body, however many members it has.
#include <algorithm>
#include <deque>

#include "simulation/debris/momentum.h"
#include "simulation/impact/first_failure.h"
#include "simulation/impact/impact_settings.h"
#include "simulation/simulation_state.h"
#include "simulation/step_clock.h"
#include "topple/structure/joint_check.h"

namespace topple::structure {

bool Simulation::State::holds_in_debris(JointId joint) const {
  return scene.frame->intact(joint) && debris_broken[static_cast<std::size_t>(joint.index)] == 0;
}

/// Only where a panel can break: others come down whole, with what most of their corners are joined to.
std::optional<std::array<double, 4>> Simulation::State::free_panel_edges(PanelId id) const {
  if (!panels.of(id).settings) return std::nullopt;
  const Panel& panel = scene.building[id];
  const BrokenPanel* broken = panels.broken(id);
  std::array<double, 4> length{};
  for (std::size_t edge = 0; edge < 4; ++edge) {
    if (!holds_in_debris(scene.building.joint(id, static_cast<int>(edge)))) continue;
    const Vec3 way = scene.building[panel.nodes[(edge + 1) % 4]].position - scene.building[panel.nodes[edge]].position;
    length[edge] = broken ? broken->edge_length(edge) : way.norm();
  }
  return length;
}

/// Its joints are asked what they bear when it is hit hard.
bool Simulation::State::may_fall_apart(const Body& one) const {
  return one.members.size() > 1 || (panels.any() && one.members.size() == 1 && !one.panels.empty());
}

FreeSegmentParts Simulation::State::parts_of(const Body& one) const {
  FreeSegmentParts parts;
  parts.members = one.members;
  parts.panels = one.panels;
  parts.nodes = one.nodes;
  // What lies frozen on a part is of its mass.
  const auto of = [&](Part part, double own) {
    for (const Debris::Frozen& lying : debris.frozen)
      if (lying.on == part) own += lying.mass.mass;
    return own;
  };
  for (const MemberId member : one.members)
    parts.member_mass.push_back(of(Part(member), debris.masses.of(member).mass));
  for (const PanelId panel : one.panels) parts.panel_mass.push_back(of(Part(panel), debris.masses.of(panel).mass));
  for (const NodeId node : one.nodes) parts.node_mass.push_back(debris.masses.of(node).mass);
  return parts;
}

bool Simulation::State::spins_hard(const Body& one, const Vec3& spin) const {
  return spin.squaredNorm() * (one.bounds.high - one.bounds.low).norm() / 2 >
         impact_settings.hard * scene.building.gravity;
}

/// Bodies of several parts that are pressed hard, or that spin fast, and what acts on them in their undeformed axes.
std::vector<Simulation::State::BodyActions> Simulation::State::pressed_hard() {
  pressing.read(contact_records, scene.scenario.step, [&](collision::BodyId id) -> std::optional<BodyPlace> {
    const auto composed = debris.bodies.composed();
    if (!std::binary_search(composed.begin(), composed.end(), id.value)) return std::nullopt;
    return BodyPlace{scene.world->state(id).pose, debris.bodies.at(id.value).rest.centre};
  });
  std::vector<BodyActions> all;
  for (const std::int64_t id : debris.bodies.composed()) {
    const Body& one = debris.bodies.at(id);
    if (debris.bodies.motion(id).asleep || !may_fall_apart(one)) continue;
    const collision::BodyState state = scene.world->state(one.id);
    if (pressing.size(one.id) <= impact_settings.hard * one.rest.mass * scene.building.gravity &&
        !spins_hard(one, state.angular_velocity))
      continue;
    const Mat3 back = state.pose.orientation.toRotationMatrix().transpose();
    all.push_back({one.id, pressing.on(one.id, scene.building), back * state.angular_velocity, back * scene.gravity});
  }
  return all;
}

/// One generation of each body after the other, until nothing breaks.
void Simulation::State::break_up_landed() {
  if (scene.world->awake_count() == 0) return;
  std::vector<BodyActions> fallen = pressed_hard();
  std::deque<BodyActions> waiting(std::make_move_iterator(fallen.begin()), std::make_move_iterator(fallen.end()));
  while (!waiting.empty()) {
    const BodyActions loading = std::move(waiting.front());
    waiting.pop_front();
    if (!break_joints_of(loading)) continue;
    for (BodyActions& part : handed_on(loading, come_apart(loading.on))) waiting.push_back(std::move(part));
  }
}

/// The impact is that of the parts it fell on; all go on to spin as the whole did.
std::vector<Simulation::State::BodyActions> Simulation::State::handed_on(
    const BodyActions& loading, const std::vector<collision::BodyId>& pieces) const {
  std::vector<BodyActions> parts;
  for (const collision::BodyId id : pieces) {
    const Body& own = debris.bodies.at(id.value);
    if (!may_fall_apart(own)) continue;
    BodyActions part{id, {}, loading.spin, loading.gravity, loading.generation + 1};
    for (const FreePush& push : loading.pushes)
      if (push.member.valid() ? std::binary_search(own.members.begin(), own.members.end(), push.member)
                              : std::find(own.panels.begin(), own.panels.end(), push.panel) != own.panels.end())
        part.pushes.push_back(push);
    if (!part.pushes.empty() || spins_hard(own, loading.spin)) parts.push_back(std::move(part));
  }
  return parts;
}

FreeSegment& Simulation::State::free_segment_of(const Body& one) {
  std::unique_ptr<FreeSegment>& segment = free_segments[one.id.value];
  if (!segment)
    segment = std::make_unique<FreeSegment>(
        scene.building, parts_of(one), [&](JointId joint) { return holds_in_debris(joint); },
        [&](PanelId shell) { return scene.frame->shell_stiffness(shell); },
        [&](PanelId panel) { return free_panel_edges(panel); });
  return *segment;
}

/// One generation of a body's breaks. False when nothing broke.
bool Simulation::State::break_joints_of(const BodyActions& loading) {
  const Body& one = debris.bodies.at(loading.on.value);
  FreeSegment& segment = free_segment_of(one);
  if (!segment.can_break()) return false;
  const FreeSegment::Answer answer = segment.bear(loading.pushes, loading.spin, loading.gravity);
  std::vector<std::pair<JointId, Utilisation>> over;
  double largest = 1;
  for (const auto& [joint, demand] : answer.demands) {
    const Utilisation used = utilisation(scene.building[joint].capacity, demand,
                                         scene.strength_factors[static_cast<std::size_t>(joint.index)]);
    if (!(used.value > 1)) continue;
    over.emplace_back(joint, used);
    largest = std::max(largest, used.value);
  }
  if (over.empty()) return false;
  std::erase_if(over,
                [&](const auto& each) { return each.second.value < (1 - impact_settings.same_instant) * largest; });
  record_breaks_in_debris(one, over, loading.generation);
  free_segments.erase(loading.on.value);
  return true;
}

/// What it is now: itself when it still hangs together.
std::vector<collision::BodyId> Simulation::State::come_apart(collision::BodyId id) {
  const std::vector<FreeSegmentParts> parts = connected_parts(
      scene.building, parts_of(debris.bodies.at(id.value)), [&](JointId joint) { return holds_in_debris(joint); },
      [&](PanelId panel) { return free_panel_edges(panel); });
  if (parts.size() == 1) return {id};
  return split(id, parts);
}

void Simulation::State::record_breaks_in_debris(const Body& one,
                                                const std::vector<std::pair<JointId, Utilisation>>& broken,
                                                int generation) {
  const collision::BodyState state = scene.world->state(one.id);
  const Mat3 turn = state.pose.orientation.toRotationMatrix();
  for (const auto& [joint, used] : broken) {
    debris_broken[static_cast<std::size_t>(joint.index)] = 1;
    JointBreak line = impact_break(joint, used);
    line.generation = generation;
    line.position = state.pose.position + turn * (scene.joint_position(joint) - one.rest.centre);
    log.record(line);
  }
}

/// Replaces the body by its parts, each with the velocity of its centre in the whole.
std::vector<collision::BodyId> Simulation::State::split(collision::BodyId id,
                                                        const std::vector<FreeSegmentParts>& parts,
                                                        std::vector<Body> chunks) {
  const Body whole = debris.bodies.at(id.value);
  const collision::BodyState state = scene.world->state(id);
  const Mat3 turn = state.pose.orientation.toRotationMatrix();
  (void)debris.resting.forget(id, *scene.frame, false);
  const std::vector<JointId> hung = hinges.take_off(id);
  debris.remove(id);
  free_segments.erase(id.value);

  std::vector<collision::BodyId> made;
  Momentum carried{state.pose.position}, handed_on{state.pose.position};
  carried.add(whole, state);
  const auto motion_of = [&](const Body& own) {
    const Vec3 arm = turn * (own.rest.centre - whole.rest.centre);
    collision::BodyState moving = state;
    moving.pose.position += arm;
    moving.velocity += state.angular_velocity.cross(arm);
    moving.asleep = false;
    return moving;
  };
  // One that is too small to be a body takes its energy with it.
  const auto go_on = [&](Body own) {
    const collision::BodyState moving = motion_of(own);
    if (own.volume < scene.scenario.debris.smallest_volume) {
      const Kinetic lost = kinetic_energy(own, moving, scene.reading());
      sums.ledger.removed += lost.translation + lost.rotation;
      for (const MemberId member : own.members) debris.lose(Part(member));
      for (const PanelId panel : own.panels) debris.lose(Part(panel));
      log.record(SimulationEvent::Kind::limited, own.name).mass = own.rest.mass;
      handed_on.add(own, moving);
      return;
    }
    made.push_back(debris.add(std::move(own), moving));
    debris.bodies.motion(made.back().value).step_start = moving.pose.position;
    handed_on.add(debris.bodies.at(made.back().value), scene.world->state(made.back()));
    changes.split.push_back({id.value, made.back().value});
  };
  for (const FreeSegmentParts& part : parts) {
    Detached piece;
    piece.members = part.members;
    piece.panels = part.panels;
    piece.nodes = part.nodes;
    const double mass = debris.masses.of(piece).mass;
    if (piece.members.empty() && piece.panels.empty() && mass <= 0) continue;  // a bare node
    Body own = describe(piece);
    if (parts.size() > 1) {
      SimulationEvent& event = log.record(SimulationEvent::Kind::split, own.name);
      event.members = own.members;
      event.panels = own.panels;
      event.mass = own.rest.mass;
      event.position = motion_of(own).pose.position;
    }
    go_on(std::move(own));
  }
  const std::size_t parts_made = made.size();
  for (Body& chunk : chunks) go_on(std::move(chunk));
  sums.ledger.momentum_error = std::max(sums.ledger.momentum_error, carried.error(handed_on));
  hinges.hang_again(hung);
  // Parts are born inside each other where they were joined.
  for (std::size_t i = 0; i < parts_made; ++i)
    for (std::size_t j = i + 1; j < parts_made; ++j) debris.pass(made[i], made[j]);
  return made;
}

}  // namespace topple::structure
