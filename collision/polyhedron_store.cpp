#include "polyhedron_store.h"

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

/// Directions of edges, each once, in the order and sense in which Bullet's own search finds them.
void add_edges(btConvexPolyhedron& solid) {
  constexpr btScalar same = 1e-6;
  const auto near_zero = [](const btVector3& v) {
    return std::abs(v.x()) <= same && std::abs(v.y()) <= same && std::abs(v.z()) <= same;
  };
  for (int f = 0; f < solid.m_faces.size(); ++f) {
    const btAlignedObjectArray<int>& face = solid.m_faces[f].m_indices;
    for (int i = 0; i < face.size(); ++i) {
      const auto [low, high] = std::minmax(face[i], face[(i + 1) % face.size()]);
      const btVector3 edge = (solid.m_vertices[low] - solid.m_vertices[high]).normalized();
      bool known = false;
      for (int e = 0; e < solid.m_uniqueEdges.size() && !known; ++e)
        known = near_zero(solid.m_uniqueEdges[e] - edge) || near_zero(solid.m_uniqueEdges[e] + edge);
      if (!known) solid.m_uniqueEdges.push_back(edge);
    }
  }
}

/// The centre of the surface, the ball about it that touches the nearest face, and a box inside: first the ball's cube,
/// then as long as the solid lets it along its longest axis, then as wide. Bullet leaves out axes along which these
/// already overlap more than the least overlap that it knows.
void add_inner_box(btConvexPolyhedron& solid) {
  solid.m_localCenter.setZero();
  btScalar area = 0;
  for (int f = 0; f < solid.m_faces.size(); ++f) {
    const btAlignedObjectArray<int>& face = solid.m_faces[f].m_indices;
    const btVector3& first = solid.m_vertices[face[0]];
    for (int i = 1; i + 1 < face.size(); ++i) {
      const btVector3 &second = solid.m_vertices[face[i]], &third = solid.m_vertices[face[i + 1]];
      const btScalar own = (first - second).cross(first - third).length() / 2;
      solid.m_localCenter += own * (first + second + third) / 3;
      area += own;
    }
  }
  solid.m_localCenter /= area;
  btVector3 low = solid.m_vertices[0], high = low;
  for (int v = 1; v < solid.m_vertices.size(); ++v) {
    low.setMin(solid.m_vertices[v]);
    high.setMax(solid.m_vertices[v]);
  }
  solid.mC = (low + high) / 2;
  solid.mE = high - low;

  const auto normal = [&](int f) {
    const btScalar* plane = solid.m_faces[f].m_plane;
    return btVector3(plane[0], plane[1], plane[2]);
  };
  const auto depth = [&](int f) { return -(normal(f).dot(solid.m_localCenter) + solid.m_faces[f].m_plane[3]); };
  solid.m_radius = BT_LARGE_FLOAT;
  for (int f = 0; f < solid.m_faces.size(); ++f) solid.m_radius = std::min(solid.m_radius, depth(f));
  const btScalar cube = solid.m_radius / std::sqrt(btScalar(3));
  btVector3 box(cube, cube, cube);
  // How far all of these axes can grow together before a corner meets a face.
  const auto grow = [&](const btVector3& axes, btScalar most) {
    for (int f = 0; f < solid.m_faces.size(); ++f) {
      const btVector3 slope = normal(f).absolute();
      const btScalar left = depth(f) - slope.dot(box), by = slope.dot(axes);
      if (by * most > left) most = std::max(btScalar(0), left / by);
    }
    constexpr btScalar rounding = 1e-9;
    box += (1 - rounding) * most * axes;
  };
  const int longest = solid.mE.maxAxis();
  btVector3 along(0, 0, 0);
  along[longest] = 1;
  grow(along, std::max(btScalar(0), solid.mE[longest] / 2 - cube));
  grow(btVector3(1, 1, 1) - along, solid.m_radius - cube);
  solid.m_extents = box;
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
  add_edges(prism);
  add_inner_box(prism);
  shape.setPolyhedralFeatures(prism);
  return true;
}

}  // namespace topple::collision
