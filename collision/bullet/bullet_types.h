#pragma once
// Bullet's linear algebra against ours. Private: no Bullet type leaves this library.
#include <LinearMath/btTransform.h>

#include "topple/collision/world.h"

namespace topple::collision {

inline btVector3 to_bullet(const Vec3& v) { return {v.x(), v.y(), v.z()}; }
inline btQuaternion to_bullet(const Eigen::Quaterniond& q) { return {q.x(), q.y(), q.z(), q.w()}; }
inline btTransform to_bullet(const Pose& pose) {
  return btTransform(to_bullet(pose.orientation.normalized()), to_bullet(pose.position));
}

inline Vec3 from_bullet(const btVector3& v) { return {v.x(), v.y(), v.z()}; }
inline Eigen::Quaterniond from_bullet(const btQuaternion& q) { return {q.w(), q.x(), q.y(), q.z()}; }
inline Mat3 from_bullet(const btMatrix3x3& m) {
  Mat3 result;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) result(row, column) = m[row][column];
  }
  return result;
}

}  // namespace topple::collision
