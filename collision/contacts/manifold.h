#pragma once
// Where two convex parts touch or are about to: at most four points with one normal.
#include <algorithm>
#include <array>
#include <limits>

#include "topple/collision/world.h"

namespace topple::collision {

/// m: two that are nearer touch where they close, and those that are proven to be farther apart do not.
inline constexpr double kTouchDistance = 1e-4;

/// Where a solid's own frame is, with its rotation as a matrix.
struct Placement {
  Vec3 position = Vec3::Zero();
  Mat3 turn = Mat3::Identity();
  [[nodiscard]] Vec3 operator*(const Vec3& local) const { return position + turn * local; }
};
template <class Archive>
void serialize(Archive& archive, Placement& of) {
  auto& [position, turn] = of;
  archive(position, turn);
}

struct ManifoldPoint {
  Vec3 on_first = Vec3::Zero(), on_second = Vec3::Zero();  ///< the two points that meet, each in its solid's frame
  double separation = 0;                                   ///< along the normal, negative inside, m
  double impulse = 0;  ///< normal force of the last sub-step, to begin the next with, N
  double force = 0;    ///< mean normal force of the last step, N
};
template <class Archive>
void serialize(Archive& archive, ManifoldPoint& of) {
  auto& [on_first, on_second, separation, impulse, force] = of;
  archive(on_first, on_second, separation, impulse, force);
}

struct Manifold {
  static constexpr int most = 4;
  int count = 0;
  std::array<ManifoldPoint, most> points;
  Vec3 normal = Vec3::Zero();          ///< from the first into the second, global
  bool normal_on_first = true;         ///< which of the two it turns with ...
  Vec3 local_normal = Vec3::Zero();    ///< ... and what it is in that one's frame
  Vec3 friction = Vec3::Zero();        ///< of the last sub-step, across the normal on the second, N, global
  double twist = 0;                    ///< the same about the normal, N m
  Vec3 friction_force = Vec3::Zero();  ///< mean of the last step, N
  double twist_force = 0;              ///< N m

  /// m: how far the nearest points are apart; infinite where there are none.
  [[nodiscard]] double nearest() const {
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < count; ++i) least = std::min(least, points[static_cast<std::size_t>(i)].separation);
    return least;
  }
  /// Whether it pushed in the last step.
  [[nodiscard]] bool bears() const {
    return std::any_of(points.begin(), points.begin() + count, [](const ManifoldPoint& one) { return one.force > 0; });
  }
};
template <class Archive>
void serialize(Archive& archive, Manifold& of) {
  auto& [count, points, normal, normal_on_first, local_normal, friction, twist, friction_force, twist_force] = of;
  archive(count, normal, normal_on_first, local_normal, friction, twist, friction_force, twist_force);
  for (int i = 0; i < count; ++i) archive(points[static_cast<std::size_t>(i)]);  // the others are room
}

}  // namespace topple::collision
