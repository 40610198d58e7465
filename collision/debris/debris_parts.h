#pragma once
// What a DebrisWorld holds: bodies, obstacles, hinges and cables.
#include <cstdint>
#include <set>
#include <vector>

#include "contacts/near_pairs.h"
#include "shapes/touching_solid.h"
#include "solver/cable_row.h"
#include "solver/hinge_rows.h"
#include "topple/collision/world_archive.h"

namespace topple::collision {

/// What a body has beside its shape and place.
struct DebrisBodyData {
  double mass = 0, friction = 0, restitution = 0;
  double ball_radius = 0;  ///< of a body that is one ball; 0: any other
  Vec3 moments = Vec3::Zero(), inverse_root_moments = Vec3::Zero();
  Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();  ///< of the principal axes
  Vec3 velocity = Vec3::Zero(), spin = Vec3::Zero();         ///< as BodyState tells them
  bool asleep = false;
  Vec3 wakes_with = Vec3::Zero(), wakes_spinning = Vec3::Zero();  ///< while it sleeps: velocity and spin when it wakes
  double slow_for = 0;                                            ///< s that it has stayed near where it was then
  Vec3 position_then = Vec3::Zero();
  Eigen::Quaterniond turn_then = Eigen::Quaterniond::Identity();
  double load = 0;          ///< m/s2: force on a contact over its effective mass, the largest; how hard it is pressed
  double substep_rate = 0;  ///< 1/s: sub-steps in the last step
  double retry_rest = 0;    ///< s until rest is tried again, where it was not found ...
  double rest_wait = 0;     ///< ... and how long that will be next time
  int ignored = 0;          ///< pairs that it is in and that are ignored until separated
  int solver = 0;           ///< its number in the step's solver
  int island = 0;
  // Of the step: what it began with, for the account of energy.
  Vec3 velocity_before = Vec3::Zero(), spin_before = Vec3::Zero();
  double energy_before = 0, pushed = 0, accounted = 0, missing = 0;
  Vec3 acceleration = Vec3::Zero();  ///< of the last step, m/s2: what lies does not fall
  double swung = 0;  ///< J by which its free rotation missed its energy: comes back, and is no contact's
  std::vector<std::uint32_t> colliders;  ///< by part
  std::set<std::int64_t> hinges, cables;
};
/// Between steps: what a step alone knows is left out, as it sets all that before it reads it.
template <class Archive>
void archive_members(Archive& archive, DebrisBodyData& of) {
  auto& [mass, friction, restitution, ball_radius, moments, inverse_root_moments, turn, velocity, spin, asleep,
         wakes_with, wakes_spinning, slow_for, position_then, turn_then, load, substep_rate, retry_rest, rest_wait,
         ignored, solver, island, velocity_before, spin_before, energy_before, pushed, accounted, missing, acceleration,
         swung, colliders, hinges, cables] = of;
  archive(mass, friction, restitution, ball_radius, moments, inverse_root_moments, turn, velocity, spin, asleep,
          wakes_with, wakes_spinning, slow_for, position_then, turn_then, load, substep_rate, retry_rest, rest_wait,
          ignored, acceleration, colliders, hinges, cables);
}

/// A body turns in its principal axes inside (its frame), and is seen in the caller's.
struct DebrisBody : TouchingSolid, DebrisBodyData {
  template <class Archive>
  void serialize(Archive& archive) {
    TouchingSolid::serialize(archive);
    archive_members(archive, *this);
  }
};

/// What an obstacle has beside its shape and place.
struct DebrisObstacleData {
  Pose pose;
  double friction = 0, restitution = 0;
  std::vector<std::uint32_t> colliders;
  // While it moves.
  bool moves = false;
  ObstacleMotion motion;
  // What touched it, about its pose: in this part of the step, N s and N m s, and in the mean of the last, N and N m.
  Vec3 impulse = Vec3::Zero(), angular_impulse = Vec3::Zero(), force = Vec3::Zero(), moment = Vec3::Zero();
  double gives_way = 1;  ///< its mobility, as a share of that which it has by itself
  double alike = 0;      ///< share of the force of the last part that was there in the one before
  double lasting = 0;    ///< share of it that goes on: the rest is part of an impact
  int known_for = 0;     ///< parts of a step, at most two
  int solver = -1;       ///< its number in the step's solver; -1: not in it yet
  int island = -1;
  Mat6 root_mobility = Mat6::Zero();  ///< for the solver, in this part of the step
};
/// As a body's.
template <class Archive>
void archive_members(Archive& archive, DebrisObstacleData& of) {
  auto& [pose, friction, restitution, colliders, moves, motion, impulse, angular_impulse, force, moment, gives_way,
         alike, lasting, known_for, solver, island, root_mobility] = of;
  archive(pose, friction, restitution, colliders, moves, motion, impulse, angular_impulse, force, moment, gives_way,
          alike, lasting, known_for);
}

struct DebrisObstacle : TouchingSolid, DebrisObstacleData {
  template <class Archive>
  void serialize(Archive& archive) {
    TouchingSolid::serialize(archive);
    archive_members(archive, *this);
  }
  /// m/s: no point of it is faster.
  [[nodiscard]] double speed() const {
    return moves ? motion.velocity.norm() + motion.angular_velocity.norm() * reach : 0;
  }
  /// Where the pose has its shapes.
  [[nodiscard]] Placement placement() const;
};

struct DebrisHinge {
  HingeRows rows;
  std::int64_t body = -1, other = -1;
  std::int64_t holder = -1;  ///< an obstacle; -1: none
  Vec3 point_on_holder = Vec3::Zero();
  Mat3 axes_on_holder = Mat3::Identity();  ///< columns; both in the obstacle's own axes
  /// What the holder got in this part of the step, where it moves: N s, and N m s about its pose's position.
  Vec3 impulse = Vec3::Zero(), angular_impulse = Vec3::Zero();
  bool pulled = false;  ///< ... and whether it got any
  Eigen::Matrix<double, 6, 1> force = Eigen::Matrix<double, 6, 1>::Zero();
  double work_lost = 0;

  void forget_step() {
    force.setZero();
    work_lost = 0;
  }
};
template <class Archive>
void serialize(Archive& archive, DebrisHinge& of) {
  auto& [rows, body, other, holder, point_on_holder, axes_on_holder, impulse, angular_impulse, pulled, force,
         work_lost] = of;
  archive(rows, body, other, holder, point_on_holder, axes_on_holder, impulse, angular_impulse, pulled, force,
          work_lost);
}

struct DebrisCable {
  CableRow row;
  std::int64_t body = -1;
  CablePull pull;
};
template <class Archive>
void serialize(Archive& archive, DebrisCable& of) {
  auto& [row, body, pull] = of;
  archive(row, body, pull);
}

/// The obstacle of a pair, if it moves; else null.
[[nodiscard]] const DebrisObstacle* moving_obstacle(const NearPairs& pairs, const PairEnds& ends);

}  // namespace topple::collision
