#include "simulation/debris/break_up.h"

#include <algorithm>
#include <deque>

#include "model/index_of.h"
#include "simulation/debris/debris_settings.h"
#include "simulation/debris/momentum.h"
#include "simulation/impact/first_failure.h"
#include "simulation/impact/impact_settings.h"
#include "simulation/step_clock.h"
#include "topple/structure/joint_check.h"

namespace topple::structure {

namespace {

std::string name_of(const Building& building, const Detached& part) {
  if (!part.members.empty()) return building[part.members.front()].name;
  if (!part.panels.empty()) return building[part.panels.front()].name;
  return building[part.nodes.front()].name;
}

bool belongs(const Detached& part, Part one) {
  const auto has = [](const auto& list, auto id) { return std::find(list.begin(), list.end(), id) != list.end(); };
  return one.member.valid() ? has(part.members, one.member) : has(part.panels, one.panel);
}

}  // namespace

BreakUp::BreakUp(const Sources& sources)
    : scene_(sources.scene),
      log_(sources.log),
      sums_(sources.sums),
      debris_(sources.debris),
      hinges_(sources.hinges),
      panels_(sources.panels),
      views_(sources.views),
      broken_(sources.scene.building.joints.size(), 0) {}

bool BreakUp::may_fall_apart(collision::BodyId id) const {
  const auto found = debris_.bodies.find(id.value);
  return found != debris_.bodies.end() && may_fall_apart(found->second);
}

Body BreakUp::describe(const Detached& part) const {
  Body one;
  one.name = name_of(scene_.building, part);
  one.members = part.members;
  one.panels = part.panels;
  one.nodes = part.nodes;
  one.rest = debris_.masses.of(part);
  for (const Debris::Frozen& lying : debris_.frozen)
    if (belongs(part, lying.on)) one.rest.add(lying.mass);
  for (const MemberId member : part.members) {
    one.volume += member_volume(scene_.building, scene_.building[member]);
    one.bounds.add(debris_.shapes.bounds(Part(member)));
  }
  for (const PanelId panel : part.panels) {
    const BrokenPanel* left = panels_.broken(panel);
    one.volume += left ? left->volume() : panel_volume(scene_.building, scene_.building[panel]);
    one.bounds.add(debris_.shapes.bounds(Part(panel)));
  }
  if (part.members.empty() && part.panels.empty()) {
    one.radius = debris_settings.node_radius;
    one.rest = sphere_mass(one.rest.centre, one.rest.mass, debris_settings.node_radius);
    one.volume =
        4.0 / 3.0 * M_PI * debris_settings.node_radius * debris_settings.node_radius * debris_settings.node_radius;
    one.bounds.low = one.rest.centre - Vec3::Constant(debris_settings.node_radius);
    one.bounds.high = one.rest.centre + Vec3::Constant(debris_settings.node_radius);
  }
  one.bounds.low -= one.rest.centre;
  one.bounds.high -= one.rest.centre;
  return one;
}

bool BreakUp::holds(JointId joint) const { return scene_.frame->intact(joint) && broken_[index_of(joint)] == 0; }

/// Only where a panel can break: others come down whole, with what most of their corners are joined to.
std::optional<std::array<double, 4>> BreakUp::free_panel_edges(PanelId id) const {
  if (!panels_.of(id).settings) return std::nullopt;
  const Panel& panel = scene_.building[id];
  const BrokenPanel* broken = panels_.broken(id);
  std::array<double, 4> length{};
  for (std::size_t edge = 0; edge < 4; ++edge) {
    if (!holds(scene_.building.joint(id, static_cast<int>(edge)))) continue;
    const Vec3 way =
        scene_.building[panel.nodes[(edge + 1) % 4]].position - scene_.building[panel.nodes[edge]].position;
    length[edge] = broken ? broken->edge_length(edge) : way.norm();
  }
  return length;
}

/// Its joints are asked what they bear when it is hit hard.
bool BreakUp::may_fall_apart(const Body& one) const {
  return one.members.size() > 1 || (panels_.any() && one.members.size() == 1 && !one.panels.empty());
}

FreeSegmentParts BreakUp::parts_of(const Body& one) const {
  FreeSegmentParts parts;
  parts.members = one.members;
  parts.panels = one.panels;
  parts.nodes = one.nodes;
  // What lies frozen on a part is of its mass.
  const auto of = [&](Part part, double own) {
    for (const Debris::Frozen& lying : debris_.frozen)
      if (lying.on == part) own += lying.mass.mass;
    return own;
  };
  for (const MemberId member : one.members)
    parts.member_mass.push_back(of(Part(member), debris_.masses.of(member).mass));
  for (const PanelId panel : one.panels) parts.panel_mass.push_back(of(Part(panel), debris_.masses.of(panel).mass));
  for (const NodeId node : one.nodes) parts.node_mass.push_back(debris_.masses.of(node).mass);
  return parts;
}

bool BreakUp::spins_hard(const Body& one, const Vec3& spin) const {
  return spin.squaredNorm() * (one.bounds.high - one.bounds.low).norm() / 2 >
         impact_settings.hard * scene_.building.gravity;
}

/// Bodies of several parts that are pressed hard, or that spin fast, and what acts on them in their undeformed axes.
std::vector<BreakUp::BodyActions> BreakUp::pressed_hard(std::span<const ContactRecord> contacts) {
  pressing_.read(contacts, scene_.scenario.step, [&](collision::BodyId id) -> std::optional<BodyPlace> {
    const auto composed = debris_.bodies.composed();
    if (!std::binary_search(composed.begin(), composed.end(), id.value)) return std::nullopt;
    return BodyPlace{scene_.world->state(id).pose, debris_.bodies.at(id.value).rest.centre};
  });
  std::vector<BodyActions> all;
  for (const std::int64_t id : debris_.bodies.composed()) {
    const Body& one = debris_.bodies.at(id);
    if (debris_.bodies.motion(id).asleep || !may_fall_apart(one)) continue;
    const collision::BodyState state = scene_.world->state(one.id);
    if (pressing_.size(one.id) <= impact_settings.hard * one.rest.mass * scene_.building.gravity &&
        !spins_hard(one, state.angular_velocity))
      continue;
    const Mat3 back = state.pose.orientation.toRotationMatrix().transpose();
    all.push_back(
        {one.id, pressing_.on(one.id, scene_.building), back * state.angular_velocity, back * scene_.gravity});
  }
  return all;
}

/// One generation of each body after the other, until nothing breaks.
void BreakUp::break_landed(std::span<const ContactRecord> contacts) {
  if (scene_.world->awake_count() == 0) return;
  std::vector<BodyActions> fallen = pressed_hard(contacts);
  std::deque<BodyActions> waiting(std::make_move_iterator(fallen.begin()), std::make_move_iterator(fallen.end()));
  while (!waiting.empty()) {
    const BodyActions loading = std::move(waiting.front());
    waiting.pop_front();
    if (!break_joints_of(loading)) continue;
    for (BodyActions& part : handed_on(loading, come_apart(loading.on))) waiting.push_back(std::move(part));
  }
}

/// The impact is that of the parts it fell on; all go on to spin as the whole did.
std::vector<BreakUp::BodyActions> BreakUp::handed_on(const BodyActions& loading,
                                                     const std::vector<collision::BodyId>& pieces) const {
  std::vector<BodyActions> parts;
  for (const collision::BodyId id : pieces) {
    const Body& own = debris_.bodies.at(id.value);
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

FreeSegment& BreakUp::free_segment_of(const Body& one) {
  std::unique_ptr<FreeSegment>& segment = free_segments_[one.id.value];
  if (!segment)
    segment = std::make_unique<FreeSegment>(
        scene_.building, parts_of(one), [&](JointId joint) { return holds(joint); },
        [&](PanelId shell) { return scene_.frame->shell_stiffness(shell); },
        [&](PanelId panel) { return free_panel_edges(panel); });
  return *segment;
}

/// One generation of a body's breaks. False when nothing broke.
bool BreakUp::break_joints_of(const BodyActions& loading) {
  const Body& one = debris_.bodies.at(loading.on.value);
  FreeSegment& segment = free_segment_of(one);
  if (!segment.can_break()) return false;
  const FreeSegment::Answer answer = segment.bear(loading.pushes, loading.spin, loading.gravity);
  std::vector<std::pair<JointId, Utilisation>> over;
  double largest = 1;
  for (const auto& [joint, demand] : answer.demands) {
    const Utilisation used =
        utilisation(scene_.building[joint].capacity, demand, scene_.strength_factors[index_of(joint)]);
    if (!(used.value > 1)) continue;
    over.emplace_back(joint, used);
    largest = std::max(largest, used.value);
  }
  if (over.empty()) return false;
  std::erase_if(over,
                [&](const auto& each) { return each.second.value < (1 - impact_settings.same_instant) * largest; });
  record_breaks(one, over, loading.generation);
  forget(loading.on);
  return true;
}

/// What it is now: itself when it still hangs together.
std::vector<collision::BodyId> BreakUp::come_apart(collision::BodyId id) {
  const std::vector<FreeSegmentParts> parts = connected_parts(
      scene_.building, parts_of(debris_.bodies.at(id.value)), [&](JointId joint) { return holds(joint); },
      [&](PanelId panel) { return free_panel_edges(panel); });
  if (parts.size() == 1) return {id};
  return split(id, parts);
}

void BreakUp::record_breaks(const Body& one, const std::vector<std::pair<JointId, Utilisation>>& broken,
                            int generation) {
  const collision::BodyState state = scene_.world->state(one.id);
  const Mat3 turn = state.pose.orientation.toRotationMatrix();
  for (const auto& [joint, used] : broken) {
    lose(joint);
    JointBreak line = impact_break(joint, used);
    line.generation = generation;
    line.position = state.pose.position + turn * (scene_.joint_position(joint) - one.rest.centre);
    log_.record(line);
  }
}

namespace {

Detached as_detached(const FreeSegmentParts& part) {
  Detached piece;
  piece.members = part.members;
  piece.panels = part.panels;
  piece.nodes = part.nodes;
  return piece;
}

void write_part(const Body& own, const Vec3& position, SimulationEvent& event) {
  event.members = own.members;
  event.panels = own.panels;
  event.mass = own.rest.mass;
  event.position = position;
}

}  // namespace

/// Replaces the body by its parts, each with the velocity of its centre in the whole.
std::vector<collision::BodyId> BreakUp::split(collision::BodyId id, const std::vector<FreeSegmentParts>& parts,
                                              std::vector<Body> chunks) {
  const Body whole = debris_.bodies.at(id.value);
  scene_.world->wake(id);
  const collision::BodyState state = scene_.world->state(id);
  const Mat3 turn = state.pose.orientation.toRotationMatrix();
  (void)debris_.resting.forget(id, *scene_.frame, false);
  const std::vector<JointId> hung = hinges_.unhook(id);
  debris_.remove(id);
  forget(id);

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
    if (own.volume < scene_.scenario.debris.smallest_volume) {
      const Kinetic lost = kinetic_energy(own, moving, scene_.reading());
      sums_.ledger.removed += lost.translation + lost.rotation;
      for (const MemberId member : own.members) debris_.lose(Part(member));
      for (const PanelId panel : own.panels) debris_.lose(Part(panel));
      log_.record(SimulationEvent::Kind::limited, own.name).mass = own.rest.mass;
      handed_on.add(own, moving);
      return;
    }
    made.push_back(debris_.add(std::move(own), moving));
    debris_.bodies.motion(made.back().value).step_start = moving.pose.position;
    handed_on.add(debris_.bodies.at(made.back().value), scene_.world->state(made.back()));
    views_.record_split(id, made.back());
  };
  for (const FreeSegmentParts& part : parts) {
    const Detached piece = as_detached(part);
    const double mass = debris_.masses.of(piece).mass;
    if (piece.members.empty() && piece.panels.empty() && mass <= 0) continue;  // a bare node
    Body own = describe(piece);
    if (parts.size() > 1)
      write_part(own, motion_of(own).pose.position, log_.record(SimulationEvent::Kind::split, own.name));
    go_on(std::move(own));
  }
  for (Body& chunk : chunks) go_on(std::move(chunk));
  sums_.ledger.momentum_error = std::max(sums_.ledger.momentum_error, carried.error(handed_on));
  hinges_.hang_again(hung);
  return made;
}

}  // namespace topple::structure
