#include "debris/scene_queries.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "contacts/contact_order.h"

namespace topple::collision {

namespace {

/// Where the ray enters the part, as a share of its way, and the outward normal there; in the solid's frame.
std::optional<std::pair<double, Vec3>> enter(const PartShape& part, const Vec3& from, const Vec3& way) {
  if (!part.polyhedron) {
    const Vec3 arm = from - part.centre;
    const double a = way.squaredNorm(), b = arm.dot(way), c = arm.squaredNorm() - part.radius * part.radius;
    const double root = b * b - a * c;
    if (root < 0 || c < 0) return std::nullopt;
    const double share = (-b - std::sqrt(root)) / a;
    if (share < 0 || share > 1) return std::nullopt;
    return std::pair(share, Vec3((arm + share * way) / part.radius));
  }
  double first = -1, last = 1;
  Vec3 normal = Vec3::Zero();
  for (const Polyhedron::Face& face : part.polyhedron->faces) {
    const double over = face.normal.dot(from) - face.offset, speed = face.normal.dot(way);
    if (speed == 0 && over > 0) return std::nullopt;
    if (speed == 0) continue;
    const double share = -over / speed;
    if (speed < 0 && share > first) first = share, normal = face.normal;
    if (speed > 0) last = std::min(last, share);
  }
  if (first < 0 || first > last) return std::nullopt;
  return std::pair(first, normal);
}

}  // namespace

std::optional<RayHit> ray_cast(const DebrisScene& scene, const Vec3& from, const Vec3& to) {
  const Vec3 way = to - from;
  double nearest = 2;
  std::uint64_t nearest_order = 0;
  std::optional<RayHit> hit;
  const auto take = [&](double share, std::uint64_t order, const Touched& what, const Vec3& normal) {
    if (share > nearest || (share == nearest && order > nearest_order)) return;
    nearest = share;
    nearest_order = order;
    hit = RayHit{what, from + share * way, normal, share * way.norm()};
  };
  const auto look_at = [&](std::uint32_t index) {
    const Collider& one = scene.pairs.collider(index);
    const Placement& at = DebrisScene::placement(*one.solid);
    const SolidPart& part = one.solid->parts[static_cast<std::size_t>(one.part)];
    const Mat3& turn = at.turn;
    const Vec3 start = turn.transpose() * (from - at.position);
    if (const auto entered =
            enter(static_cast<const TouchingSolid*>(one.solid)->shapes[static_cast<std::size_t>(one.part)], start,
                  turn.transpose() * way))
      take(entered->first, one.order, touched(*one.solid, part.tag), turn * entered->second);
  };
  const Box3 box{from.cwiseMin(to), from.cwiseMax(to)};
  scene.pairs.each_in(box, true, look_at);
  scene.pairs.each_in(box, false, look_at);
  if (scene.ground.there && from.z() > scene.ground.height && to.z() <= scene.ground.height)
    take((scene.ground.height - from.z()) / way.z(), std::numeric_limits<std::uint64_t>::max(),
         touched(scene.ground.solid, -1), {0, 0, 1});
  return hit;
}

std::vector<ObstacleId> obstacles_in(const DebrisScene& scene, const Vec3& low, const Vec3& high) {
  std::vector<ObstacleId> result;
  scene.pairs.each_in({low, high}, true,
                      [&](std::uint32_t index) { result.push_back({scene.pairs.collider(index).solid->id}); });
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

}  // namespace topple::collision
