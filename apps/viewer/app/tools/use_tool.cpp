// What the tool in hand does where a person points.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>

#include "app/controller.h"

namespace topple::viewer {
namespace {

structure::Vec3 to_eigen(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

}  // namespace

void Controller::click(glm::dvec2 pixel) {
  if (tool == ToolKind::fire) return fire(pixel);
  const auto found = pick_at(pixel);
  if (!found || !found->joint.valid()) {
    message = std::string(tool_names[static_cast<std::size_t>(tool)]) + ": nothing of the building is there";
    return;
  }
  if (tool == ToolKind::select) return select(*found);
  if (looking_at_) go_on_from_here();
  use(*found);
}

void Controller::use(const Pick& found) {
  const auto said = [&](const std::string& what) { message = what; };
  switch (tool) {
    case ToolKind::cut:
      driver_.apply(structure::CutTool{{found.joint}});
      return said("cut " + building_[found.joint].name);
    case ToolKind::remove: {
      structure::RemoveTool gone;
      if (found.member.valid()) gone.members = {found.member};
      if (found.panel.valid()) gone.panels = {found.panel};
      driver_.apply(gone);
      return said("removed " + (found.member.valid() ? building_[found.member].name : building_[found.panel].name));
    }
    case ToolKind::support:
      return remove_support_at(found);
    case ToolKind::charge:
      driver_.apply(structure::ChargeTool{to_eigen(found.point), charge_radius, 0, 1});
      return said("charge at " + building_[found.joint].name);
    case ToolKind::swing:
      return swing_at(found);
    case ToolKind::burn:
      return burn_at(found);
    case ToolKind::explosion:
      return explode_at(found);
    case ToolKind::thermite: {
      if (!found.member.valid()) return said("thermite: click a post, beam or brace");
      const Thermite thermite{found.joint, thermite_over};
      driver_.order_and_show([thermite](Session& session) { session.burn_through(thermite); });
      return said("thermite at " + building_[found.joint].name);
    }
    case ToolKind::hook:
      return pull_at(found);
    case ToolKind::path: {
      const structure::ContactPlace place{found.member, found.panel, to_eigen(found.point)};
      driver_.order_and_show([place](Session& session) { session.find_path(place); });
      options.colouring = Colouring::path;
      return said("the way of a downward force on " + building_[found.joint].name);
    }
    default:
      return;
  }
}

void Controller::remove_support_at(const Pick& found) {
  if (!found.member.valid()) {
    message = "remove support: click a member that stands on one";
    return;
  }
  const auto supported = [&](structure::NodeId node) {
    return std::any_of(building_.supports.begin(), building_.supports.end(),
                       [node](const structure::NodeSupport& s) { return s.node == node; });
  };
  for (const structure::NodeId node : building_[found.member].nodes) {
    if (!supported(node)) continue;
    driver_.apply(structure::RemoveTool{{}, {}, {node}});
    message = "removed the support of " + building_[node].name;
    return;
  }
  message = "remove support: " + building_[found.member].name + " stands on none";
}

/// The ball is lowest, and fastest, where it meets the place; it comes from the side of the eye.
void Controller::swing_at(const Pick& found) {
  glm::dvec2 way(found.point.x - camera.eye.x, found.point.y - camera.eye.y);
  way = glm::length(way) > 1e-9 ? glm::normalize(way) : glm::dvec2(1, 0);
  const glm::dvec3 ahead(way, 0);
  const glm::dvec3 lowest = found.point - swing.radius * ahead;
  const glm::dvec3 anchor = lowest + glm::dvec3(0, 0, swing.cable);
  structure::WreckingBall ball;
  ball.anchor = to_eigen(anchor);
  ball.from =
      to_eigen(anchor - swing.cable * (std::sin(swing.angle) * ahead + glm::dvec3(0, 0, std::cos(swing.angle))));
  // Taut, whatever rounding has made of the place.
  ball.cable = std::max(swing.cable, (ball.anchor - ball.from).norm());
  ball.mass = swing.mass;
  ball.radius = swing.radius;
  driver_.apply(ball);
  message = "a ball swings at " + building_[found.joint].name;
}

/// The charge hangs half a metre before what is seen.
void Controller::explode_at(const Pick& found) {
  constexpr double before = 0.5;
  const glm::dvec3 back = glm::normalize(camera.eye - found.point);
  const Explosion explosion{to_eigen(found.point + before * back), explosive};
  driver_.order_and_show([explosion](Session& session) { session.explode(explosion); });
  char text[48];
  std::snprintf(text, sizeof text, "%.3g kg of TNT explode at ", explosive);
  message = text + building_[found.joint].name;
}

/// At the nearest end of the member, or corner of the panel; the winch stands on the ground as far away as the building
/// is high, and half of that more.
void Controller::pull_at(const Pick& found) {
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
  if (!nearest.valid()) return;
  glm::dvec2 way(camera.eye.x - found.point.x, camera.eye.y - found.point.y);
  way = glm::length(way) > 1e-9 ? glm::normalize(way) : glm::dvec2(1, 0);
  const structure::Vec3 at = place_of(nearest);
  const double away = 5 + 1.5 * std::max(0.0, at.z() - ground_);
  const Pull pull{nearest, {at.x() + away * way.x, at.y() + away * way.y, ground_}, hauling.force, hauling.over};
  driver_.order_and_show([pull](Session& session) { session.pull(pull); });
  message = "a winch pulls at " + building_[nearest].name;
}

void Controller::shake() {
  auto ground = std::make_shared<structure::TimeHistory>(shaking.file.empty()
                                                             ? strong_motion(shaking.peak, shaking.over)
                                                             : structure::read_time_history(shaking.file, building_));
  require_ground(*ground);
  if (looking_at_) go_on_from_here();
  const Earthquake earthquake{std::move(ground)};
  driver_.order_and_show([earthquake](Session& session) { session.shake(earthquake); });
  message = "the ground shakes";
}

void Controller::burn_at(const Pick& found) {
  structure::WeakenTool fire;
  const structure::Vec3 place = to_eigen(found.point);
  const auto near = [&](const structure::Vec3& p) { return (p - place).norm() <= burning.reach; };
  for (std::size_t m = 0; m < building_.members.size(); ++m) {
    const structure::Member& member = building_.members[m];
    const structure::Vec3 ends[] = {building_[member.nodes[0]].position, building_[member.nodes[1]].position};
    if (near((ends[0] + ends[1]) / 2)) fire.members.emplace_back(m);
    for (int end = 0; end < 2; ++end)
      if (near(ends[end])) fire.joints.push_back(building_.joint(structure::MemberId(m), end));
  }
  std::sort(fire.joints.begin(), fire.joints.end());
  if (fire.members.empty() && fire.joints.empty()) {
    message = "burn: nothing is within " + std::to_string(burning.reach) + " m";
    return;
  }
  fire.strength = burning.strength;
  fire.stiffness = burning.stiffness;
  fire.over = burning.over;
  fire.stages = burning_stages;
  message = std::to_string(fire.members.size()) + " members and " + std::to_string(fire.joints.size()) +
            " joints burn around " + building_[found.joint].name;
  driver_.apply(fire);
}

void Controller::fire(glm::dvec2 pixel) {
  const Ray ray = camera.ray(pixel, size_);
  const auto target = pick_at(pixel);
  if (looking_at_) go_on_from_here();
  const double distance = target ? target->distance : camera.distance();
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
