#include "overlaps.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace topple::bench {

namespace {

using Eigen::Vector3d;

struct Extent {
  double low = std::numeric_limits<double>::infinity(), high = -low;
};

Extent along(const PlacedSolid& solid, const Vector3d& axis) {
  Extent extent;
  for (const Vector3d& corner : solid.corners) {
    const double at = axis.dot(corner);
    extent.low = std::min(extent.low, at);
    extent.high = std::max(extent.high, at);
  }
  return extent;
}

bool bounds_meet(const PlacedSolid& first, const PlacedSolid& second) {
  return (first.low.array() <= second.high.array()).all() && (second.low.array() <= first.high.array()).all();
}

}  // namespace

PlacedSolid::PlacedSolid(const ConvexSolid& solid, const Vector3d& position, const Eigen::Quaterniond& orientation) {
  const Eigen::Matrix3d turn = orientation.toRotationMatrix();
  low.setConstant(std::numeric_limits<double>::infinity());
  high = -low;
  for (const Vector3d& corner : solid.corners) {
    corners.emplace_back(position + turn * corner);
    low = low.cwiseMin(corners.back());
    high = high.cwiseMax(corners.back());
  }
  for (const Vector3d& normal : solid.normals) normals.emplace_back(turn * normal);
  for (const Vector3d& edge : solid.edges) edges.emplace_back(turn * edge);
}

double overlap(const PlacedSolid& first, const PlacedSolid& second) {
  double least = std::numeric_limits<double>::infinity();
  const auto parts = [&](const Vector3d& axis) {
    const Extent a = along(first, axis), b = along(second, axis);
    least = std::min({least, a.high - b.low, b.high - a.low});
    return least < 0;
  };
  for (const PlacedSolid* one : {&first, &second})
    for (const Vector3d& normal : one->normals)
      if (parts(normal)) return least;
  for (const Vector3d& a : first.edges)
    for (const Vector3d& b : second.edges) {
      const Vector3d across = a.cross(b);
      const double size = across.norm();
      // Nearly parallel edges: the normals beside them part what this axis would.
      if (size > 1e-6 && parts(across / size)) return least;
    }
  return least;
}

Overlaps find_overlaps(std::span<const PlacedSolid> bodies, std::span<const PlacedSolid> standing, bool ground) {
  Overlaps found;
  const auto count = [&](double depth) {
    found.over_10_mm += depth > 0.01 ? 1 : 0;
    found.over_20_mm += depth > 0.02 ? 1 : 0;
    found.deepest = std::max(found.deepest, depth);
  };
  std::vector<std::size_t> order(bodies.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return bodies[a].low.x() < bodies[b].low.x(); });
  for (std::size_t i = 0; i < order.size(); ++i) {
    const PlacedSolid& one = bodies[order[i]];
    if (ground) count(-one.low.z());
    for (const PlacedSolid& other : standing)
      if (bounds_meet(one, other)) count(overlap(one, other));
    for (std::size_t j = i + 1; j < order.size() && bodies[order[j]].low.x() <= one.high.x(); ++j)
      if (bounds_meet(one, bodies[order[j]])) count(overlap(one, bodies[order[j]]));
  }
  return found;
}

}  // namespace topple::bench
