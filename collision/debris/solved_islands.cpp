#include "debris/solved_islands.h"

#include <algorithm>
#include <cmath>

#include "debris/body_motion.h"

namespace topple::collision {

namespace {

/// For which a piece of a loop is worth being handed on.
constexpr std::size_t kSolvedBodies = 32, kPairs = 64;

/// Along the axis on which they are spread widest: what is near each other is then near in memory, and on one thread.
void order_in_space(std::vector<DebrisBody*>& bodies) {
  Vec3 middle = Vec3::Zero(), spread = Vec3::Zero();
  for (const DebrisBody* one : bodies) middle += one->at.position;
  middle /= static_cast<double>(bodies.size());
  for (const DebrisBody* one : bodies) spread += (one->at.position - middle).cwiseAbs();
  Eigen::Index axis = 0;
  spread.maxCoeff(&axis);
  std::stable_sort(bodies.begin(), bodies.end(), [axis](const DebrisBody* a, const DebrisBody* b) {
    return a->at.position[axis] < b->at.position[axis];
  });
}

}  // namespace

template <class Work>
void SolvedIslands::each_solved(const Work& work) {
  region_.each(solving_.size(), kSolvedBodies, [&](std::size_t i) { work(*solving_[i]); });
}

void SolvedIslands::fill(std::span<Island* const> islands, double dt, int substeps) {
  solver_.clear();
  solving_.clear();
  for (const std::int64_t id : scene_.moving_obstacles) scene_.obstacle(id).solver = -1;
  for (const Island* island : islands) solving_.insert(solving_.end(), island->bodies.begin(), island->bodies.end());
  std::size_t contacts = 0;
  for (const Island* island : islands) contacts += island->pairs.size();
  if (substeps > 0 && solver_.domains_of(contacts) > 1) order_in_space(solving_);
  for (DebrisBody* one : solving_) {
    SolverBody moving;
    moving.at = one->at;
    moving.inverse_root_mass = 1 / std::sqrt(one->mass);
    moving.inverse_root_moments = one->inverse_root_moments;
    moving.velocity = one->velocity;
    moving.spin = one->spin;
    moving.acceleration = scene_.gravity;
    one->solver = solver_.add(moving);
  }
  solver_.end_of_order();
  if (substeps > 0)
    for (const Island* island : islands) moving_.add_to(solver_, *island, dt, dt / substeps);
  for (const Island* island : islands) add_contacts(*island);
}

/// With the friction and restitution of the two, and their numbers in the solver.
SolverContact SolvedIslands::solver_contact(std::uint32_t index) const {
  struct Side {
    int number = 0;
    double friction = 0, restitution = 0;
    bool asleep = false;
    double ball_radius = 0;
  };
  const auto side = [&](const Solid& solid) -> Side {
    if (solid.kind == Touched::Kind::ground) return {0, scene_.ground.friction, scene_.ground.restitution};
    if (solid.kind == Touched::Kind::obstacle) {
      const auto& one = static_cast<const DebrisObstacle&>(solid);
      return {one.moves ? std::max(0, one.solver) : 0, one.friction, one.restitution};
    }
    const auto& one = static_cast<const DebrisBody&>(solid);
    return {one.asleep ? 0 : one.solver, one.friction, one.restitution, one.asleep, one.ball_radius};
  };
  const PairEnds& ends = scene_.pairs.ends(index);
  const Solid &first = *scene_.pairs.collider(ends.first).solid, &second = *scene_.pairs.collider(ends.second).solid;
  const Side a = side(first), b = side(second);
  SolverContact contact;
  contact.pair = &scene_.pairs.pair(index);
  contact.first = a.number;
  contact.second = b.number;
  contact.first_at = &DebrisScene::placement(first);
  contact.second_at = &DebrisScene::placement(second);
  contact.friction = std::sqrt(a.friction * b.friction);
  contact.restitution = std::sqrt(a.restitution * b.restitution);
  contact.held = ends.rests && a.asleep != b.asleep;
  contact.first_ball = a.ball_radius > 0;
  contact.second_ball = b.ball_radius > 0;
  contact.rolling = scene_.settings.rolling_resistance * std::max(a.ball_radius, b.ball_radius);
  contact.points = contact.pair->manifold.count;
  contact.corners_on_second = contact.pair->manifold.normal_on_first;
  return contact;
}

void SolvedIslands::add_contacts(const Island& island) {
  const std::span<SolverContact> made = solver_.add_contacts(island.pairs.size());
  region_.each(made.size(), kPairs, [&](std::size_t i) { made[i] = solver_contact(island.pairs[i]); });
  for (DebrisHinge* hinge : island.hinges) add(*hinge);
  for (DebrisCable* cable : island.cables) {
    cable->row.body = scene_.body(cable->body).solver;
    cable->row.impulse.setZero();
    cable->row.pulled = 0;
    solver_.add(&cable->row);
  }
}

void SolvedIslands::add(DebrisHinge& hinge) {
  HingeRows& rows = hinge.rows;
  rows.body = scene_.body(hinge.body).solver;
  rows.holder = hinge.other < 0 ? 0 : scene_.body(hinge.other).solver;
  if (hinge.holder >= 0) {
    const DebrisObstacle& on = scene_.obstacle(hinge.holder);
    rows.holder = on.moves ? std::max(0, on.solver) : 0;
    const Placement at = rows.holder == 0 ? Placement{} : solver_.body(rows.holder).at;
    rows.point_in_holder = at.turn.transpose() * (on.pose * hinge.point_on_holder - at.position);
    rows.axes_in_holder = at.turn.transpose() * (on.pose.orientation * hinge.axes_on_holder);
  }
  solver_.add(&rows);
}

void SolvedIslands::update_bodies(double dt) {
  each_solved([&](DebrisBody& one) {
    const SolverBody& moved = solver_.body(one.solver);
    one.velocity = moved.velocity;
    one.acceleration = (moved.velocity - one.velocity_before) / dt;
    one.spin = moved.spin;
    one.at.position += moved.moved;
    one.load *= 0.9;  // so that the number of sub-steps does not follow the solver's chatter
  });
  for (const SolverContact& contact : solver_.contacts())
    for (const bool second : {false, true})
      if (DebrisBody* one = body_of(contact, second)) one->load = std::max(one->load, contact.load);
  resist_rolling();
  each_solved([&](DebrisBody& one) { turn(one, solver_.body(one.solver).turned, dt); });
}

/// A ball on soil: by the normal force times a share of its radius.
void SolvedIslands::resist_rolling() {
  for (const SolverContact& contact : solver_.contacts())
    for (const bool second : {false, true}) {
      DebrisBody* ball = body_of(contact, second);
      if (!ball || ball->ball_radius == 0) continue;
      const double pressed = std::abs(contact.impulse.dot(contact.pair->manifold.normal)), spin = ball->spin.norm();
      const double slowed = scene_.settings.rolling_resistance * ball->ball_radius * pressed / ball->moments.x();
      if (spin > 0) ball->spin *= std::max(0.0, spin - slowed) / spin;
    }
}

void SolvedIslands::read_joints(std::span<Island* const> islands, double dt) const {
  for (const Island* island : islands) {
    for (DebrisHinge* hinge : island->hinges) {
      const HingeRows& rows = hinge->rows;
      const Mat3 axes = (solver_.body(rows.holder).at.turn * rows.axes_in_holder).transpose();
      hinge->force.head<3>() -= axes * rows.force_total / dt;
      hinge->force.tail<3>() -= axes * rows.moment_total / dt;
    }
    for (DebrisCable* cable : island->cables) cable->pull.tension += cable->row.pulled / dt;
  }
}

void SolvedIslands::run(double dt, int substeps) {
  each_solved([&](DebrisBody& one) {
    one.substep_rate = substeps / dt;
    one.velocity_before = one.velocity;
    one.spin_before = one.spin;
    one.energy_before = energy(one, scene_.gravity, dt);
  });
  solver_.run(dt, substeps);
}

DebrisBody* SolvedIslands::body_of(const SolverContact& solved, bool second) const {
  const auto number = static_cast<std::size_t>(second ? solved.second : solved.first);
  return number == 0 || number > solving_.size() ? nullptr : solving_[number - 1];
}

}  // namespace topple::collision
