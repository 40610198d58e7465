#include "app/tools/use_tool.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>

namespace topple::viewer {
namespace {

structure::Vec3 to_eigen(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

}  // namespace

std::optional<std::string> ToolUse::on(const Pick& found) const {
  switch (hand_.tool) {
    case ToolKind::cut:
      driver_.apply(structure::CutTool{{found.joint}});
      return "cut " + building_[found.joint].name;
    case ToolKind::remove: {
      structure::RemoveTool gone;
      if (found.member.valid()) gone.members = {found.member};
      if (found.panel.valid()) gone.panels = {found.panel};
      driver_.apply(gone);
      return "removed " + (found.member.valid() ? building_[found.member].name : building_[found.panel].name);
    }
    case ToolKind::support:
      return remove_support(found);
    case ToolKind::charge:
      driver_.apply(structure::ChargeTool{to_eigen(found.point), hand_.charge_radius, 0, 1});
      return "charge at " + building_[found.joint].name;
    case ToolKind::swing:
      return swing(found);
    case ToolKind::burn:
      return burn(found);
    case ToolKind::explosion:
      return explode(found);
    case ToolKind::thermite: {
      if (!found.member.valid()) return "thermite: click a post, beam or brace";
      const Thermite thermite{found.joint, hand_.thermite_over};
      driver_.order_and_show([thermite](Session& session) { session.burn_through(thermite); });
      return "thermite at " + building_[found.joint].name;
    }
    case ToolKind::hook:
      return pull(found);
    case ToolKind::path: {
      const structure::ContactPlace place{found.member, found.panel, to_eigen(found.point)};
      driver_.order_and_show([place](Session& session) { session.find_path(place); });
      return "the way of a downward force on " + building_[found.joint].name;
    }
    default:
      return std::nullopt;
  }
}

std::string ToolUse::remove_support(const Pick& found) const {
  if (!found.member.valid()) return "remove support: click a member that stands on one";
  const auto supported = [&](structure::NodeId node) {
    return std::any_of(building_.supports.begin(), building_.supports.end(),
                       [node](const structure::NodeSupport& s) { return s.node == node; });
  };
  for (const structure::NodeId node : building_[found.member].nodes) {
    if (!supported(node)) continue;
    driver_.apply(structure::RemoveTool{{}, {}, {node}});
    return "removed the support of " + building_[node].name;
  }
  return "remove support: " + building_[found.member].name + " stands on none";
}

/// The ball is lowest, and fastest, where it meets the place; it comes from the side of the eye.
std::string ToolUse::swing(const Pick& found) const {
  glm::dvec2 way(found.point.x - camera_.eye.x, found.point.y - camera_.eye.y);
  way = glm::length(way) > 1e-9 ? glm::normalize(way) : glm::dvec2(1, 0);
  const glm::dvec3 ahead(way, 0);
  const glm::dvec3 lowest = found.point - hand_.swing.radius * ahead;
  const glm::dvec3 anchor = lowest + glm::dvec3(0, 0, hand_.swing.cable);
  structure::WreckingBall ball;
  ball.anchor = to_eigen(anchor);
  ball.from = to_eigen(anchor - hand_.swing.cable * (std::sin(hand_.swing.angle) * ahead +
                                                     glm::dvec3(0, 0, std::cos(hand_.swing.angle))));
  // Taut, whatever rounding has made of the place.
  ball.cable = std::max(hand_.swing.cable, (ball.anchor - ball.from).norm());
  ball.mass = hand_.swing.mass;
  ball.radius = hand_.swing.radius;
  driver_.apply(ball);
  return "a ball swings at " + building_[found.joint].name;
}

/// The charge hangs half a metre before what is seen.
std::string ToolUse::explode(const Pick& found) const {
  constexpr double before = 0.5;
  const glm::dvec3 back = glm::normalize(camera_.eye - found.point);
  const Explosion explosion{to_eigen(found.point + before * back), hand_.explosive};
  driver_.order_and_show([explosion](Session& session) { session.explode(explosion); });
  char text[48];
  std::snprintf(text, sizeof text, "%.3g kg of TNT explode at ", hand_.explosive);
  return text + building_[found.joint].name;
}

/// At the nearest end of the member, or corner of the panel; the winch stands on the ground as far away as the building
/// is high, and half of that more.
std::optional<std::string> ToolUse::pull(const Pick& found) const {
  const auto place_of = [&](structure::NodeId node) { return building_[node].position; };
  structure::NodeId nearest;
  const auto look_at_node = [&](structure::NodeId node) {
    const structure::Vec3 point = to_eigen(found.point);
    if (!nearest.valid() || (place_of(node) - point).norm() < (place_of(nearest) - point).norm()) nearest = node;
  };
  if (found.member.valid())
    for (const structure::NodeId node : building_[found.member].nodes) look_at_node(node);
  if (found.panel.valid())
    for (const structure::NodeId node : building_[found.panel].nodes) look_at_node(node);
  if (!nearest.valid()) return std::nullopt;
  glm::dvec2 way(camera_.eye.x - found.point.x, camera_.eye.y - found.point.y);
  way = glm::length(way) > 1e-9 ? glm::normalize(way) : glm::dvec2(1, 0);
  const structure::Vec3 at = place_of(nearest);
  const double away = 5 + 1.5 * std::max(0.0, at.z() - ground_);
  const Pull pull{
      nearest, {at.x() + away * way.x, at.y() + away * way.y, ground_}, hand_.hauling.force, hand_.hauling.over};
  driver_.order_and_show([pull](Session& session) { session.pull(pull); });
  return "a winch pulls at " + building_[nearest].name;
}

std::string ToolUse::burn(const Pick& found) const {
  structure::WeakenTool fire;
  const structure::Vec3 place = to_eigen(found.point);
  const auto near = [&](const structure::Vec3& p) { return (p - place).norm() <= hand_.burning.reach; };
  for (std::size_t m = 0; m < building_.members.size(); ++m) {
    const structure::Member& member = building_.members[m];
    const structure::Vec3 ends[] = {building_[member.nodes[0]].position, building_[member.nodes[1]].position};
    if (near((ends[0] + ends[1]) / 2)) fire.members.emplace_back(m);
    for (int end = 0; end < 2; ++end)
      if (near(ends[end])) fire.joints.push_back(building_.joint(structure::MemberId(m), end));
  }
  std::sort(fire.joints.begin(), fire.joints.end());
  if (fire.members.empty() && fire.joints.empty())
    return "burn: nothing is within " + std::to_string(hand_.burning.reach) + " m";
  fire.strength = hand_.burning.strength;
  fire.stiffness = hand_.burning.stiffness;
  fire.over = hand_.burning.over;
  fire.stages = burning_stages;
  driver_.apply(fire);
  return std::to_string(fire.members.size()) + " members and " + std::to_string(fire.joints.size()) +
         " joints burn around " + building_[found.joint].name;
}

void ToolUse::fire(const Ray& ray, const std::optional<Pick>& target) const {
  const Shot& shot = hand_.shot;
  const double distance = target ? target->distance : camera_.distance();
  const double flight = distance / shot.speed;
  const glm::dvec3 velocity =
      shot.speed * ray.direction + glm::dvec3(0, 0, building_.gravity * flight / 2);  // falls g t^2/2 on the way
  structure::Projectile projectile;
  projectile.from = to_eigen(ray.origin);
  projectile.velocity = to_eigen(velocity);
  projectile.mass = shot.mass;
  projectile.radius = shot.radius;
  driver_.apply(projectile);
}

}  // namespace topple::viewer
