#include "debris/moving_obstacles.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <utility>

namespace topple::collision {

namespace {

/// What a force and a moment about its place do to it: m/s2, rad/s2.
std::pair<Vec3, Vec3> answer(const ObstacleMotion& motion, const Vec3& force, const Vec3& moment) {
  if (!motion.mobility) return {force / motion.mass, motion.inertia.inverse() * moment};
  Eigen::Matrix<double, 6, 1> both;
  both << force, moment;
  both = *motion.mobility * both;
  return {both.head<3>(), both.tail<3>()};
}

}  // namespace

void MovingObstacles::update(double dt, MovingStructure& structure) {
  std::vector<std::int64_t> near;
  for (const std::uint32_t index : scene_.pairs.order()) {
    const Solid* second = scene_.pairs.collider(scene_.pairs.pair(index).second).solid;
    if (second->kind == Touched::Kind::obstacle) near.push_back(second->id);
  }
  for (const auto& [id, hinge] : scene_.hinges)
    if (hinge->holder >= 0) near.push_back(hinge->holder);
  std::sort(near.begin(), near.end());
  near.erase(std::unique(near.begin(), near.end()), near.end());
  const std::vector<std::int64_t> before = scene_.moving_obstacles;
  for (const std::int64_t id : near) {
    DebrisObstacle& one = scene_.obstacle(id);
    if (const std::optional<ObstacleMotion> motion = structure.motion({id}))
      update(one, *motion, dt);
    else if (one.moves)
      stand_still(one);
  }
  for (const std::int64_t id : before)
    if (!std::binary_search(near.begin(), near.end(), id)) stand_still(scene_.obstacle(id));
}

void MovingObstacles::update(DebrisObstacle& one, const ObstacleMotion& motion, double dt) {
  const bool first = !one.moves;
  if (first) {
    one.moves = true;
    scene_.moving_obstacles.insert(
        std::lower_bound(scene_.moving_obstacles.begin(), scene_.moving_obstacles.end(), one.id), one.id);
    one.impulse = one.angular_impulse = one.force = one.moment = Vec3::Zero();
  }
  if (first || motion.held_anew) {
    one.gives_way = 1;
    one.alike = 0;
    one.known_for = 0;
  }
  const Vec3 force = std::exchange(one.impulse, Vec3::Zero()) / dt,
             moment = std::exchange(one.angular_impulse, Vec3::Zero()) / dt;
  one.known_for = std::min(one.known_for + 1, 2);
  estimate_compliance(one, motion, force, moment);
  one.force = force;
  one.moment = moment;
  one.motion = motion;
  one.pose = motion.pose;
  one.at = one.placement();
  one.add_way();
  const Vec3 straight = motion.velocity * dt;
  const double spin = motion.angular_velocity.norm() * dt;
  for (std::size_t i = 0; i < one.parts.size(); ++i) {
    Box3 bounds = scene_.bounds_of(one.shapes[i], one.at);
    const Vec3 out = Vec3::Constant(spin * one.parts[i].reach);
    bounds.low += straight.cwiseMin(0) - out;
    bounds.high += straight.cwiseMax(0) + out;
    scene_.pairs.move(one.colliders[i], bounds, scene_.settings.fat);
    scene_.pairs.note_way(one.colliders[i], one.gone, straight.norm() + spin * one.parts[i].reach, true);
  }
}

/// From what it did in the last two parts of a step: the share of its own mobility that its accelerations show, and
/// how much of the force goes on.
void MovingObstacles::estimate_compliance(DebrisObstacle& one, const ObstacleMotion& now, const Vec3& force,
                                          const Vec3& moment) const {
  const auto product = [&](const Vec3& a, const Vec3& turning_a, const Vec3& b, const Vec3& turning_b) {
    const auto [moved, turned] = answer(now, b, turning_b);
    return a.dot(moved) + turning_a.dot(turned);
  };
  const double present = product(force, moment, force, moment),
               before = product(one.force, one.moment, one.force, one.moment);
  const Vec3 more = force - one.force, more_moment = moment - one.moment;
  const double own = product(more, more_moment, more, more_moment);
  const double alike = present > own ? 1 - std::sqrt(own / present) : 0;
  one.lasting = std::min(alike, std::exchange(one.alike, alike));  // an impact takes two parts
  if (now.mobility || one.known_for < 2) return;                   // what it would have done otherwise is not known yet
  if (!(own > scene_.settings.telling_change * std::max(before, present))) return;
  const double shown = more.dot(now.last_acceleration - one.motion.acceleration) +
                       more_moment.dot(now.last_angular_acceleration - one.motion.angular_acceleration);
  if (shown > 0)
    one.gives_way = std::clamp(shown / own, scene_.settings.gives_way_least, scene_.settings.gives_way_most);
}

void MovingObstacles::stand_still(DebrisObstacle& one) {
  one.moves = false;
  std::erase(scene_.moving_obstacles, one.id);
  for (std::size_t i = 0; i < one.parts.size(); ++i) {
    scene_.pairs.move(one.colliders[i], scene_.bounds_of(one.shapes[i], one.at), 0);
    scene_.pairs.note_way(one.colliders[i], one.gone, 0, false);
  }
}

void MovingObstacles::add_to(StepSolver& solver, const Island& island, double dt, double substep) {
  for (const std::uint32_t index : island.pairs) {
    Solid* const second = scene_.pairs.collider(scene_.pairs.pair(index).second).solid;
    if (second->kind != Touched::Kind::obstacle) continue;
    auto& one = static_cast<DebrisObstacle&>(*second);
    if (one.moves && one.solver <= 0) add(one, solver, dt, substep);
  }
  for (const DebrisHinge* hinge : island.hinges)
    if (DebrisObstacle* one = scene_.moving_holder(*hinge); one && one->solver <= 0) add(*one, solver, dt, substep);
}

void MovingObstacles::add(DebrisObstacle& one, StepSolver& solver, double dt, double substep) {
  SolverBody moving;
  moving.at.position = one.pose.position;
  if (one.motion.mobility) {
    one.root_mobility = one.motion.mobility->llt().matrixL();  // it tells it by itself: `gives_way` is 1
    moving.root_mobility = &one.root_mobility;
    moving.at.turn.setIdentity();
  } else {
    const Eigen::SelfAdjointEigenSolver<Mat3> principal(one.motion.inertia);
    moving.at.turn = principal.eigenvectors();
    if (moving.at.turn.determinant() < 0) moving.at.turn.col(2) *= -1;
    moving.inverse_root_mass = std::sqrt(one.gives_way / one.motion.mass);
    moving.inverse_root_moments = std::sqrt(one.gives_way) * principal.eigenvalues().cwiseSqrt().cwiseInverse();
  }
  const auto [moved, turned] = answer(one.motion, one.force, one.moment);
  const Vec3 by_force = one.gives_way * moved, by_moment = one.gives_way * turned;
  // As it went on, without what touched it then.
  moving.acceleration = one.motion.acceleration - by_force;
  moving.angular_acceleration = one.motion.angular_acceleration - by_moment;
  // The solver begins half a sub-step before the part does; there what lasts acted already.
  moving.velocity = one.motion.velocity - moving.acceleration * (dt / 2) - one.lasting * by_force * (substep / 2);
  moving.spin =
      one.motion.angular_velocity - moving.angular_acceleration * (dt / 2) - one.lasting * by_moment * (substep / 2);
  one.solver = solver.add(moving);
}

/// After a part of a step: what was done to the obstacles, and how they would go on by themselves.
void MovingObstacles::read_motion(const StepSolver& solver, std::span<Island* const> islands, double dt) {
  if (scene_.moving_obstacles.empty()) return;
  for (const SolverContact& solved : solver.contacts()) {
    if (solved.second == 0) continue;
    Solid* const second = scene_.pairs.collider(solved.pair->second).solid;
    if (second->kind != Touched::Kind::obstacle) continue;
    auto& one = static_cast<DebrisObstacle&>(*second);
    one.impulse += solved.impulse;
    one.angular_impulse += (solved.centre - one.pose.position).cross(solved.impulse) + solved.moment;
  }
  for (const Island* island : islands)
    for (DebrisHinge* hinge : island->hinges) {
      DebrisObstacle* const one = scene_.moving_holder(*hinge);
      if (!one || hinge->rows.holder == 0) continue;
      one->impulse -= hinge->rows.force_total;
      one->angular_impulse += hinge->rows.moment_where_it_was;
      hinge->impulse -= hinge->rows.force_total;
      hinge->angular_impulse += hinge->rows.moment_where_it_was;
      hinge->pulled = true;
    }
  for (const std::int64_t id : scene_.moving_obstacles) {
    DebrisObstacle& one = scene_.obstacle(id);
    if (one.solver <= 0) continue;
    const SolverBody& moved = solver.body(one.solver);
    one.motion.velocity = moved.velocity + moved.acceleration * (dt / 2);
    one.motion.angular_velocity = moved.spin + moved.angular_acceleration * (dt / 2);
  }
}

std::vector<HingePull> MovingObstacles::extract_pulls() {
  std::vector<HingePull> pulls;
  for (auto& [id, hinge] : scene_.hinges) {
    if (!std::exchange(hinge->pulled, false)) continue;
    const Pose& pose = scene_.obstacle(hinge->holder).pose;
    HingePull& pull = pulls.emplace_back();
    pull.hinge = {id};
    pull.holder = {hinge->holder};
    pull.point = pose * hinge->point_on_holder;
    pull.impulse = std::exchange(hinge->impulse, Vec3::Zero());
    pull.moment =
        std::exchange(hinge->angular_impulse, Vec3::Zero()) - (pull.point - pose.position).cross(pull.impulse);
  }
  return pulls;
}

/// What sleeps on something that moves at a noticeable speed, or hangs at it, goes along, awake.
void MovingObstacles::wake_carried() {
  const auto carries = [&](const DebrisObstacle& one, const Vec3& place) {
    const Vec3 velocity = one.motion.velocity + one.motion.angular_velocity.cross(Vec3(place - one.pose.position));
    return velocity.norm() > scene_.settings.carries_from;
  };
  if (scene_.moving_obstacles.empty()) return;
  for (const std::uint32_t index : scene_.touching) {
    const NearPair& pair = scene_.pairs.pair(index);
    const DebrisObstacle* const carrier = moving_obstacle(scene_.pairs, scene_.pairs.ends(index));
    auto* const first = static_cast<DebrisBody*>(scene_.pairs.collider(pair.first).solid);
    if (!carrier || !first->asleep) continue;
    for (int i = 0; i < pair.manifold.count; ++i)
      if (carries(*carrier, carrier->at * pair.manifold.points[static_cast<std::size_t>(i)].on_second))
        scene_.wake_up(*first);
  }
  for (const auto& [id, hinge] : scene_.hinges) {
    const DebrisObstacle* const carrier = scene_.moving_holder(*hinge);
    DebrisBody& hung = scene_.body(hinge->body);
    if (carrier && hung.asleep && carries(*carrier, carrier->pose * hinge->point_on_holder)) scene_.wake_up(hung);
  }
}

}  // namespace topple::collision
