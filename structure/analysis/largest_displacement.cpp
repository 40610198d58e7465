#include "analysis/largest_displacement.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "model/index_of.h"

namespace topple::structure {

namespace {

constexpr int places = 64;  // a parabola's peak between two of them is missed by 1/16384 of its height

/// Motion of a member's end, after its offset.
Vec3 end_motion(const Member& member, std::size_t end, const std::vector<Vec6>& displacements) {
  const Vec6& u = displacements[index_of(member.nodes[end])];
  return u.head<3>() + Vec3(u.tail<3>()).cross(member.offsets[end]);
}

double largest_of(const MemberResult& member, std::size_t quantity) {
  return std::max(std::abs(member.min[quantity].value), std::abs(member.max[quantity].value));
}

/// Of a cubic between two places, in local axes.
double largest_between(const std::array<Vec3, 2>& u, const std::array<Vec3, 2>& r, double L) {
  constexpr int along = 16;
  double largest = 0;
  for (int i = 1; i < along; ++i) {
    const double s = static_cast<double>(i) / along;
    const double h1 = 1 - 3 * s * s + 2 * s * s * s, h2 = L * s * (1 - s) * (1 - s), h3 = 1 - h1,
                 h4 = -L * s * s * (1 - s);
    const Vec3 moved(u[0].x() + s * (u[1].x() - u[0].x()),
                     h1 * u[0].y() + h2 * r[0].z() + h3 * u[1].y() + h4 * r[1].z(),
                     h1 * u[0].z() - h2 * r[0].y() + h3 * u[1].z() - h4 * r[1].y());
    largest = std::max(largest, moved.norm());
  }
  return largest;
}

}  // namespace

LargestDisplacement largest_displacement(const Building& building, const CombinationResult& result,
                                         const DeflectionAt& deflection) {
  LargestDisplacement largest;
  for (std::size_t n = 0; n < result.displacements.size(); ++n) {
    const Vec3 moved = result.displacements[n].head<3>();
    if (n > 0 && moved.norm() <= largest.value) continue;
    largest = {moved.norm(), moved, NodeId(n), {}, 0, -1};
  }
  for (std::size_t n = 0; n < result.mesh_displacements.size(); ++n) {
    const Vec3 moved = result.mesh_displacements[n].head<3>();
    if (moved.norm() <= largest.value) continue;
    largest = {moved.norm(), moved, {}, {}, 0, static_cast<int>(n)};
  }
  std::vector<std::pair<double, std::size_t>> bounds;
  for (std::size_t m = 0; m < result.members.size(); ++m) {
    const Member& member = building.members[m];
    const double ends = std::max(end_motion(member, 0, result.displacements).norm(),
                                 end_motion(member, 1, result.displacements).norm());
    const double bound = ends + std::hypot(largest_of(result.members[m], 6), largest_of(result.members[m], 7));
    if (bound > largest.value) bounds.emplace_back(bound, m);
  }
  std::sort(bounds.begin(), bounds.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  for (const auto& [bound, m] : bounds) {
    if (bound <= largest.value) break;
    const Member& member = building.members[m];
    const Vec3 first = end_motion(member, 0, result.displacements), last = end_motion(member, 1, result.displacements);
    for (int i = 0; i <= places; ++i) {
      const double share = static_cast<double>(i) / places;
      const Vec2 bent = deflection(m, share * member.length);
      const Vec3 moved = first + share * (last - first) + member.axes.transpose() * Vec3(0, bent.x(), bent.y());
      if (moved.norm() > largest.value) largest = {moved.norm(), moved, {}, MemberId(m), share * member.length, -1};
    }
  }
  return largest;
}

double largest_in_shape(const Building& building, const std::vector<Vec6>& shape,
                        const std::vector<std::vector<int>>& cuts) {
  double largest = 0;
  for (const Vec6& motion : shape) largest = std::max(largest, motion.head<3>().norm());
  for (std::size_t m = 0; m < building.members.size(); ++m) {
    const Member& member = building.members[m];
    std::vector<Vec3> moved{member.axes * end_motion(member, 0, shape)};
    std::vector<Vec3> turned{member.axes * shape[index_of(member.nodes[0])].tail<3>()};
    for (std::size_t i = 0; i < (cuts.empty() ? 0 : cuts[m].size()); ++i) {
      const Vec6& inner = shape[static_cast<std::size_t>(cuts[m][i])];
      moved.emplace_back(member.axes * inner.head<3>());
      turned.emplace_back(member.axes * inner.tail<3>());
    }
    moved.emplace_back(member.axes * end_motion(member, 1, shape));
    turned.emplace_back(member.axes * shape[index_of(member.nodes[1])].tail<3>());
    const double length = member.length / static_cast<double>(moved.size() - 1);
    for (std::size_t i = 0; i + 1 < moved.size(); ++i)
      largest = std::max(largest, largest_between({moved[i], moved[i + 1]}, {turned[i], turned[i + 1]}, length));
  }
  return largest;
}

}  // namespace topple::structure
