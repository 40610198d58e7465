#include "debris/body_motion.h"

#include <cmath>

#include "solver/free_rotation.h"

namespace topple::collision {

void turn(DebrisBody& one, const Vec3& turned, double dt) {
  one.swung = 0;
  if (one.spin.isZero(0) && turned.isZero(0)) return;
  const Vec3 more = turned - one.spin * dt;
  FreeRotation free{one.turn, one.spin};
  const bool round = one.moments.x() == one.moments.y() && one.moments.y() == one.moments.z();
  if (round) {
    const double angle = turned.norm();
    if (angle > 0) free.orientation = Eigen::Quaterniond(Eigen::AngleAxisd(angle, turned / angle)) * one.turn;
    one.turn = free.orientation.normalized();
    one.at.turn = one.turn.toRotationMatrix();
    return;
  }
  const auto spinning = [&](const FreeRotation& now) {
    const Vec3 spin = now.orientation.conjugate() * now.spin;
    return spin.dot(one.moments.cwiseProduct(spin)) / 2;
  };
  const double before_turning = spinning(free);
  free = rotated_freely(free, one.moments, dt);
  one.swung = spinning(free) - before_turning;
  one.turn = free.orientation;
  one.spin = free.spin;
  const double angle = more.norm();
  if (angle > 1e-14) {
    const Eigen::Quaterniond before = one.turn;
    one.turn = (Eigen::Quaterniond(Eigen::AngleAxisd(angle, more / angle)) * before).normalized();
    const Vec3 momentum = before * one.moments.cwiseProduct(before.conjugate() * one.spin);
    one.spin = one.turn * (one.turn.conjugate() * momentum).cwiseQuotient(one.moments);
  }
  one.at.turn = one.turn.toRotationMatrix();
}

void fly(DebrisBody& one, const Vec3& gravity, double dt) {
  one.acceleration = gravity;
  one.velocity += gravity * dt;
  one.at.position += one.velocity * dt;
  one.load = one.substep_rate = 0;
  turn(one, one.spin * dt, dt);
}

double energy(const DebrisBody& one, const Vec3& gravity, double dt) {
  const Vec3 velocity = one.velocity + gravity * (dt / 2), spin = one.at.turn.transpose() * one.spin;
  return one.mass * (velocity.squaredNorm() / 2 - gravity.dot(one.at.position)) +
         spin.dot(one.moments.cwiseProduct(spin)) / 2;
}

}  // namespace topple::collision
