#include "shapes/polyhedron_store.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace topple::collision {

namespace {
/// Shapes kept; a world that has seen more starts anew.
constexpr std::size_t most_kept = 20000;
}  // namespace

void PolyhedronStore::give_features(btPolyhedralConvexShape& shape, const std::vector<double>& made_from) {
  if (const auto found = known_.find(made_from); found != known_.end()) {
    shape.setPolyhedralFeatures(found->second);
    return;
  }
  shape.initializePolyhedralFeatures();
  if (shape.getConvexPolyhedron() == nullptr) return;
  if (known_.size() >= most_kept) known_.clear();
  known_.emplace(made_from, *shape.getConvexPolyhedron());
}

void PolyhedronStore::take(const PolyhedronStore& from, const std::vector<double>& made_from) {
  if (const auto found = from.known_.find(made_from); found != from.known_.end()) known_.insert(*found);
}

namespace {

/// Rounding of coordinates, of the size of what they belong to; corners closer to a straight line than this (sine) are
/// better sought.
constexpr double rounding = 1e-9, least_turn = 1e-6;

bool is_prism(const std::vector<Eigen::Vector3d>& points) {
  const std::size_t corners = points.size() / 2;
  if (corners < 3 || points.size() % 2 != 0) return false;
  const Eigen::Vector3d across = points[1] - points[0];
  const double size = (points[2] - points[0]).norm() + across.norm();
  Eigen::Vector3d round = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < corners; ++i) {
    if ((points[2 * i + 1] - points[2 * i] - across).norm() > rounding * size) return false;
    if (std::abs((points[2 * i] - points[0]).dot(across)) > rounding * size * size) return false;
    const Eigen::Vector3d way = points[2 * ((i + 1) % corners)] - points[2 * i],
                          next = points[2 * ((i + 2) % corners)] - points[2 * ((i + 1) % corners)];
    const Eigen::Vector3d turn = way.cross(next);
    if (turn.norm() <= least_turn * way.norm() * next.norm() || turn.dot(round) < 0) return false;
    round += turn;
  }
  // Round once: the turns add up to one, which the angles of a polygon that goes round more often do not.
  double angle = 0;
  for (std::size_t i = 0; i < corners; ++i) {
    const Eigen::Vector3d way = points[2 * ((i + 1) % corners)] - points[2 * i],
                          next = points[2 * ((i + 2) % corners)] - points[2 * ((i + 1) % corners)];
    angle += std::atan2(way.cross(next).norm(), way.dot(next));
  }
  return angle < 3 * M_PI;
}

}  // namespace

bool PolyhedronStore::give_prism(btPolyhedralConvexShape& shape, const std::vector<Eigen::Vector3d>& points) {
  if (!is_prism(points)) return false;
  btConvexPolyhedron prism;
  for (const Eigen::Vector3d& point : points) prism.m_vertices.push_back(btVector3(point.x(), point.y(), point.z()));
  const int corners = static_cast<int>(points.size()) / 2;
  const auto at = [&](int corner, int end) -> const btVector3& {
    return prism.m_vertices[2 * (corner % corners) + end];
  };
  const btVector3 across = at(0, 1) - at(0, 0);
  btVector3 round(0, 0, 0);  // the first end's area, as its corners go
  for (int i = 1; i + 1 < corners; ++i) round += (at(i, 0) - at(0, 0)).cross(at(i + 1, 0) - at(0, 0));
  const bool forward = round.dot(across) > 0;  // counter-clockwise, seen from the second end
  const auto add = [&](const btVector3& outward, const auto& vertex_of, int count) {
    btFace face;
    for (int i = 0; i < count; ++i) face.m_indices.push_back(vertex_of(i));
    const btVector3 normal = outward.normalized();
    // The plane through the innermost of its corners, as Bullet's own search takes it.
    btScalar offset = BT_LARGE_FLOAT;
    for (int i = 0; i < count; ++i) offset = std::min(offset, normal.dot(prism.m_vertices[face.m_indices[i]]));
    face.m_plane[0] = normal.x();
    face.m_plane[1] = normal.y();
    face.m_plane[2] = normal.z();
    face.m_plane[3] = -offset;
    prism.m_faces.push_back(face);
  };
  for (int end = 0; end < 2; ++end) {
    const bool as_given = forward == (end == 1);
    const btVector3 outward = (forward ? round : -round) * (end == 1 ? 1 : -1);
    add(
        outward, [&](int i) { return 2 * (as_given ? i : corners - 1 - i) + end; }, corners);
  }
  for (int i = 0; i < corners; ++i) {
    const int next = (i + 1) % corners;
    const btVector3 side = (at(next, 0) - at(i, 0)).cross(across);
    const std::array<int, 4> given{2 * i, 2 * next, 2 * next + 1, 2 * i + 1};
    add(
        forward ? side : -side, [&](int k) { return given[static_cast<std::size_t>(forward ? k : 3 - k)]; }, 4);
  }
  shape.setPolyhedralFeatures(prism);
  return true;
}

}  // namespace topple::collision
