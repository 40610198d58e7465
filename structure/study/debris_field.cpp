#include "study/debris_field.h"

#include <algorithm>
#include <limits>

namespace topple::structure::study {

namespace {

double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

double distance_to_edge(const Vec2& a, const Vec2& b, const Vec2& point) {
  const Vec2 along = b - a;
  const double length = along.squaredNorm();
  const double at = length > 0 ? std::clamp((point - a).dot(along) / length, 0.0, 1.0) : 0;
  return (point - a - at * along).norm();
}

std::vector<Vec3> positions_of(const Building& building, const BodyView& body) {
  std::vector<Vec3> places;
  const auto moved = [&](const Vec3& offset) {
    places.emplace_back(body.pose.position + body.pose.orientation * offset);
  };
  if (body.chunk) {
    for (const auto& vertex : body.chunk->positions) moved(Vec3(vertex[0], vertex[1], vertex[2]));
    return places;
  }
  for (const MemberId member : body.members)
    for (std::size_t end = 0; end < 2; ++end)
      moved(building[building[member].nodes[end]].position + building[member].offsets[end] - body.rest_centre);
  for (const PanelId panel : body.panels)
    for (const NodeId node : building[panel].nodes) moved(building[node].position - body.rest_centre);
  if (places.empty()) moved(Vec3::Zero());
  return places;
}

}  // namespace

std::vector<Vec2> convex_hull(std::vector<Vec2> points) {
  const auto before = [](const Vec2& a, const Vec2& b) { return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y(); };
  std::sort(points.begin(), points.end(), before);
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() < 3) return points;
  std::vector<Vec2> hull;
  for (int side = 0; side < 2; ++side) {
    const std::size_t from = hull.size();
    for (const Vec2& point : points) {
      while (hull.size() >= from + 2 && cross(hull.back() - hull[hull.size() - 2], point - hull.back()) <= 0)
        hull.pop_back();
      hull.push_back(point);
    }
    hull.pop_back();  // where the other side begins
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

double area_of(const std::vector<Vec2>& hull) {
  double twice = 0;
  for (std::size_t i = 0; i < hull.size(); ++i)
    twice += cross(hull[i] - hull[0], hull[(i + 1) % hull.size()] - hull[0]);
  return 0.5 * std::abs(twice);
}

double distance_outside(const std::vector<Vec2>& hull, const Vec2& point) {
  bool inside = hull.size() > 2;
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Vec2 &a = hull[i], &b = hull[(i + 1) % hull.size()];
    inside = inside && cross(b - a, point - a) >= 0;
    nearest = std::min(nearest, distance_to_edge(a, b, point));
  }
  return inside || hull.empty() ? 0 : nearest;
}

double footprint_without_farthest(std::vector<FallenBody> bodies, double mass) {
  std::stable_sort(bodies.begin(), bodies.end(),
                   [](const FallenBody& a, const FallenBody& b) { return a.reach > b.reach; });
  std::vector<Vec2> places;
  double farther = 0;
  for (const FallenBody& body : bodies) {
    farther += body.mass;
    if (farther > mass) places.insert(places.end(), body.places.begin(), body.places.end());
  }
  return area_of(convex_hull(std::move(places)));
}

DebrisField debris_field(const Simulation& simulation) {
  std::vector<Vec2> standing;
  for (const Node& node : simulation.building().nodes) standing.emplace_back(node.position.x(), node.position.y());
  const std::vector<Vec2> was = convex_hull(std::move(standing));
  double ground = std::numeric_limits<double>::infinity();
  for (const Node& node : simulation.building().nodes) ground = std::min(ground, node.position.z());
  DebrisField field;
  std::vector<Vec2> all;
  std::vector<FallenBody> bodies;
  double mass = 0, outside = 0, top = ground;
  for (const BodyView& body : simulation.bodies()) {
    if (body.radius > 0) continue;
    std::vector<Vec2> places;
    std::size_t beyond = 0;
    double farthest = 0;
    for (const Vec3& at : positions_of(simulation.building(), body)) {
      top = std::max(top, at.z());
      const Vec2& place = places.emplace_back(at.head<2>());
      const double distance = distance_outside(was, place);
      farthest = std::max(farthest, distance);
      beyond += distance > 0;
    }
    field.reach = std::max(field.reach, farthest);
    mass += body.mass;
    outside += body.mass * static_cast<double>(beyond) / static_cast<double>(places.size());
    all.insert(all.end(), places.begin(), places.end());
    bodies.push_back({farthest, body.mass, places});
  }
  const Building& building = simulation.building();
  for (std::size_t m = 0; m < building.members.size(); ++m)
    if (simulation.frame().stands(MemberId(m)))
      for (const NodeId node : building.members[m].nodes) top = std::max(top, building[node].position.z());
  field.height = top - ground;
  constexpr double most = 0.95;
  field.footprint_95 = footprint_without_farthest(std::move(bodies), (1 - most) * mass);
  field.footprint = area_of(convex_hull(std::move(all)));
  field.outside = mass > 0 ? outside / mass : 0;
  return field;
}

}  // namespace topple::structure::study
