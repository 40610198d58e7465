#include "app/target_building.h"

#include <algorithm>
#include <glm/common.hpp>
#include <limits>
#include <numeric>
#include <vector>

#include "renderer/instances/scene_instances.h"

namespace topple::viewer {
namespace {

using structure::Building;
using structure::NodeId;
using structure::Vec3;

/// For each node the first node that members and panels join it with.
std::vector<std::size_t> building_of_nodes(const Building& building) {
  std::vector<std::size_t> leader(building.nodes.size());
  std::iota(leader.begin(), leader.end(), std::size_t{0});
  const auto find = [&](NodeId node) {
    auto i = static_cast<std::size_t>(node.index);
    while (leader[i] != i) i = leader[i] = leader[leader[i]];
    return i;
  };
  const auto join = [&](NodeId a, NodeId b) {
    const std::size_t i = find(a), j = find(b);
    leader[std::max(i, j)] = std::min(i, j);
  };
  for (const structure::Member& member : building.members) join(member.nodes[0], member.nodes[1]);
  for (const structure::Panel& panel : building.panels)
    for (const NodeId node : panel.nodes) join(panel.nodes[0], node);
  for (std::size_t i = 0; i < leader.size(); ++i) leader[i] = find(NodeId(i));
  return leader;
}

const structure::Projectile* first_ball(const structure::Scenario& scenario) {
  for (const structure::Event& event : scenario.events)
    if (const auto* ball = std::get_if<structure::Projectile>(&event.tool)) return ball;
  return nullptr;
}

/// How far a point lies from the half line that a ball flies along.
double away(const structure::Projectile& ball, const Vec3& point) {
  const Vec3 way = ball.velocity.normalized(), to = point - ball.from;
  return (to - std::max(0.0, to.dot(way)) * way).norm();
}

}  // namespace

Bounds bounds_of_target(const Building& building, const structure::Scenario& scenario) {
  const Bounds all = bounds_of(building);
  const structure::Projectile* ball = first_ball(scenario);
  if (ball == nullptr || !(ball->velocity.norm() > 0) || building.nodes.empty()) return all;
  const std::vector<std::size_t> leader = building_of_nodes(building);
  std::size_t target = 0;
  // The nearest to where it flies; of those as near (to a metre), the one that it reaches first.
  double best = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < building.nodes.size(); ++i) {
    const Vec3& at = building.nodes[i].position;
    const double value = std::max(1.0, away(*ball, at)) + 1e-3 * (at - ball->from).norm();
    if (value < best) best = value, target = leader[i];
  }
  Bounds bounds{glm::dvec3(std::numeric_limits<double>::infinity()),
                glm::dvec3(-std::numeric_limits<double>::infinity())};
  for (std::size_t i = 0; i < building.nodes.size(); ++i) {
    if (leader[i] != target) continue;
    const Vec3& p = building.nodes[i].position;
    bounds.low = glm::min(bounds.low, glm::dvec3(p.x(), p.y(), p.z()));
    bounds.high = glm::max(bounds.high, glm::dvec3(p.x(), p.y(), p.z()));
  }
  return bounds;
}

}  // namespace topple::viewer
