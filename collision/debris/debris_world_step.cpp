// The step: bounds, contacts, islands, sub-steps, what it did.
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "debris/debris_world.h"
#include "solver/free_rotation.h"

namespace topple::collision {

namespace {
/// Fewer are not worth the ten microseconds that helpers take to come.
constexpr std::size_t kContactsShared = 100, kPairsShared = 500;
/// For which a piece of a loop is worth being handed on.
constexpr std::size_t kBodies = 32, kPairs = 64, kDuePairs = 8;
}  // namespace

void DebrisWorld::begin_step(double dt) {
  if (!(dt > 0) || !std::isfinite(dt))
    throw std::invalid_argument("step of " + std::to_string(dt) + " s; it must be above zero");
  std::erase_if(released_, [&](const auto& one) { return one.second + 1 < step_number_; });
  release_separated(dt, true);
  contacts_.clear();
  for (const std::int64_t id : std::exchange(slept_now_, {}))
    if (DebrisBody* one = bodies_[static_cast<std::size_t>(id)].get()) one->slept_now = false;
  if (awake_count_ == 0) return;
  ++step_number_;
  for (auto& [id, hinge] : hinges_)
    if (!body(hinge->body).asleep) hinge->forget_step();
  for (auto& [id, cable] : cables_)
    if (!body(cable->body).asleep) cable->pull = {};
}

void DebrisWorld::step(double dt) { advance(dt, 1, nullptr); }

/// In `parts` after each of which the structure goes on, and each of those in as many as fast spins need. Without a
/// structure obstacles stand still.
void DebrisWorld::advance(double dt, int parts, MovingStructure* structure) {
  const double part_time = dt / parts;
  if (structure) {
    place_moving(part_time, *structure);
    find_touching();
    wake_carried();
  }
  begin_step(dt);
  while (!structure && !moving_obstacles_.empty()) stand_still(obstacle(moving_obstacles_.back()));
  if (!structure && awake_count_ == 0) return;
  find_contacts(part_time);
  const int finer = (parts_of_step(dt) + parts - 1) / parts;
  gather_islands();
  parts_ = 1;
  if (finer == 1) fall_asleep_where_held(dt);
  parts_ = parts * finer;
  read_velocities_by(gravity_ * ((1 - 1.0 / parts_) * dt / 2));
  for (int part = 0; part < parts; ++part) {
    const std::size_t told = contacts_.size();
    if (part > 0) place_moving(part_time, *structure);
    for (int i = 0; i < finer && (awake_count_ > 0 || !moving_obstacles_.empty()); ++i) {
      if (part + i > 0) {
        find_contacts(dt / parts_);
        gather_islands();
      }
      if (awake_count_ > 0) move_on(dt / parts_);
    }
    if (structure) hand_over(part_time, told, *structure);
  }
  read_velocities_by(Vec3::Zero());
  merge_contacts();
}

/// Before a step is solved, in one.
void DebrisWorld::fall_asleep_where_held(double dt) {
  bool slept = false;
  for (Island& island : islands_) {
    Island quiet = island.carried ? quiet_part(island) : island;
    slept = come_to_rest(quiet, dt) || slept;
  }
  if (slept) gather_islands();
}

/// One part of a step, once contacts and islands are found.
void DebrisWorld::move_on(double dt) {
  std::map<int, std::vector<Island*>> by_substeps;
  for (Island& island : islands_) {
    if (island.pairs.empty() && island.hinges.empty() && island.cables.empty())
      fly(*island.bodies.front(), dt);
    else
      by_substeps[substeps(island, dt)].push_back(&island);
  }
  const auto solve_all = [&] {
    for (const auto& [count, islands] : by_substeps) solve(islands, count, dt);
  };
  impulses_.clear();
  touching_.size() >= kContactsShared ? region_.run(solve_all) : solve_all();
  wake_changed(dt);
  look_for_rest(dt);
}

/// Contacts are planes at points that stay through a step. A body that spins leaves them by reach (1 - cos(w dt)): the
/// step is taken in so many parts, each with contacts of its own, that this is small for all that touch.
int DebrisWorld::parts_of_step(double dt) const {
  double most = 0;
  const auto look_at = [&](std::uint32_t collider) {
    const Solid& solid = *pairs_.collider(collider).solid;
    if (solid.kind != Touched::Kind::body) return;
    const auto& one = static_cast<const DebrisBody&>(solid);
    if (one.asleep || one.ball_radius > 0) return;
    const double angle = std::min(M_PI, one.spin.norm() * dt);
    most = std::max(most, one.reach * (1 - std::cos(angle)));
  };
  for (const std::uint32_t index : touching_) {
    const NearPair& pair = pairs_.pair(index);
    look_at(pair.first);
    if (pair.second != NearPairs::ground) look_at(pair.second);
  }
  return std::clamp(static_cast<int>(std::ceil(std::sqrt(most / settings_.leaves_plane))), 1, settings_.most_parts);
}

/// Stored velocities are those of the middle of a step; in its parts, those of the middle of a part: this much more.
void DebrisWorld::read_velocities_by(const Vec3& more) {
  for (const BodyId id : order_)
    if (DebrisBody& one = body(id.value); !one.asleep) one.velocity += more - reading_;
  reading_ = more;
}

void DebrisWorld::update_bounds(double dt) {
  for (const BodyId id : order_) {
    DebrisBody& one = body(id.value);
    if (one.asleep) continue;
    const Vec3 way = (one.velocity + gravity_ * dt) * dt;
    const double spin = one.spin.norm() * dt;
    for (std::size_t i = 0; i < one.parts.size(); ++i) {
      Box3 bounds = bounds_of(one.shapes[i], one.at);
      const Vec3 out = Vec3::Constant(settings_.margin + std::min(1.0, spin) * one.parts[i].reach);
      bounds.low += way.cwiseMin(0) - out;
      bounds.high += way.cwiseMax(0) + out;
      pairs_.move(one.colliders[i], bounds, settings_.fat + way.norm());
    }
  }
}

bool DebrisWorld::awake(const NearPair& pair) const {
  const auto moves = [&](std::uint32_t collider) {
    const Solid* solid = pairs_.collider(collider).solid;
    return solid->kind == Touched::Kind::body && !static_cast<const DebrisBody*>(solid)->asleep;
  };
  return moves(pair.first) || moves(pair.second);
}

namespace {

const Placement& placement(const Solid& solid) {
  static const Placement unplaced;
  return solid.kind == Touched::Kind::ground ? unplaced : static_cast<const TouchingSolid&>(solid).at;
}

}  // namespace

/// No point of a body comes farther in the step than this: by its contacts it may lose its speed, but what pushes it
/// comes with that much itself.
void DebrisWorld::note_ways(double dt) {
  const Vec3 half_kick = gravity_ * (dt / 2);
  const auto note = [&](DebrisBody& one) {
    one.look_how_far();
    const double straight = one.asleep ? 0 : (one.velocity + half_kick).norm() * dt;
    const double spin = one.asleep ? 0 : one.spin.norm() * dt;
    for (std::size_t i = 0; i < one.parts.size(); ++i)
      pairs_.note_way(one.colliders[i], one.gone, straight + spin * one.parts[i].reach, !one.asleep);
  };
  region_.each(order_.size(), kBodies, [&](std::size_t i) { note(body(order_[i].value)); });
}

/// m: how near they are looked at. What could come together within the step is a contact already. Two that fly side by
/// side may: the one in front is stopped in this step, and the one behind goes on.
double DebrisWorld::margin_of(const Collider& a, const Collider& b) const {
  return std::max(settings_.margin, a.way + b.way);
}

/// Whether its two may have come together or apart since they were last looked at.
bool DebrisWorld::is_due(const PairEnds& ends) const {
  const Collider &a = pairs_.collider(ends.first), &b = pairs_.collider(ends.second);
  return (a.moves || b.moves) && a.gone + b.gone + margin_of(a, b) >= ends.free_until;
}

void DebrisWorld::seek(std::uint32_t index) {
  PairEnds& ends = pairs_.ends(index);
  const Collider &a = pairs_.collider(ends.first), &b = pairs_.collider(ends.second);
  const bool far = ends.second != NearPairs::ground && !a.tight.meets(b.tight);
  if (far || (!ignored_.empty() && ignores(*a.solid, *b.solid))) {
    if (!ends.touches) return;
    NearPair& parted = pairs_.pair(index);
    if (far) parted.sought = false;
    parted.manifold.count = 0;
    ends.touches = false;
    return;
  }
  NearPair& pair = pairs_.pair(index);
  PairMotion motion;
  const auto shape = [](const Collider& of) {
    return &static_cast<const TouchingSolid*>(of.solid)->shapes[static_cast<std::size_t>(of.part)];
  };
  motion.first = shape(a);
  motion.second = ends.second == NearPairs::ground ? nullptr : shape(b);
  motion.first_at = &placement(*a.solid);
  motion.second_at = &placement(*b.solid);
  motion.margin = margin_of(a, b);
  motion.ground_height = ground_height_;
  ends.free_until = a.gone + b.gone + update_contacts(pair, motion, settings_.kept, settings_.matched);
  ends.touches = pair.manifold.count > 0;
}

/// Each pair by itself. Few of those that are near are due.
void DebrisWorld::seek_contacts() {
  due_.clear();
  const std::vector<std::uint32_t>& order = pairs_.order();
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (i + 4 * kAhead < order.size()) __builtin_prefetch(&pairs_.ends(order[i + 4 * kAhead]));
    if (is_due(pairs_.ends(order[i]))) due_.push_back(order[i]);
  }
  region_.each(due_.size(), kDuePairs, [&](std::size_t i) {
    if (i + kAhead < due_.size()) prefetch_lines(pairs_.pair(due_[i + kAhead]));
    seek(due_[i]);
  });
}

void DebrisWorld::find_contacts(double dt) {
  const auto find = [&] {
    wake_hinged();
    update_bounds(dt);
    pairs_.find();
    note_ways(dt);
    seek_contacts();
    find_touching();
    wake_carried();
    wake_struck(dt);
  };
  pairs_.order().size() >= kPairsShared ? region_.run(find) : find();
}

void DebrisWorld::find_touching() {
  touching_.clear();
  for (const std::uint32_t index : pairs_.order())
    if (pairs_.ends(index).touches) touching_.push_back(index);
}

/// A body that nothing touches: exactly.
void DebrisWorld::fly(DebrisBody& one, double dt) const {
  one.acceleration = gravity_;
  one.velocity += gravity_ * dt;
  one.at.position += one.velocity * dt;
  one.load = one.substep_rate = 0;
  turn(one, one.spin * dt, dt);
}

/// As a free body that has the momentum with which the step ended, and by what its contacts turned it otherwise: the
/// momentum stays, to rounding.
void DebrisWorld::turn(DebrisBody& one, const Vec3& turned, double dt) const {
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

/// Along the axis on which they are spread widest: what is near each other is then near in memory, and on one thread.
void DebrisWorld::order_in_space(std::vector<DebrisBody*>& bodies) {
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

/// `substeps` of `dt`: for which obstacles that move go on; with none they stand still as the others.
void DebrisWorld::fill_solver(std::span<Island* const> islands, double dt, int substeps) {
  solver_.clear();
  solving_.clear();
  for (const std::int64_t id : moving_obstacles_) obstacle(id).solver = -1;
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
    moving.acceleration = gravity_;
    one->solver = solver_.add(moving);
  }
  solver_.end_of_order();
  if (substeps > 0)
    for (const Island* island : islands) add_moving(*island, dt, dt / substeps);
  for (const Island* island : islands) add_contacts(*island);
}

/// With the friction and restitution of the two, and their numbers in the solver.
SolverContact DebrisWorld::solver_contact(std::uint32_t index) {
  struct Side {
    int number = 0;
    double friction = 0, restitution = 0;
  };
  const auto side = [&](const Solid& solid) -> Side {
    if (solid.kind == Touched::Kind::ground) return {0, ground_friction_, ground_restitution_};
    if (solid.kind == Touched::Kind::obstacle) {
      const auto& one = static_cast<const DebrisObstacle&>(solid);
      return {one.moves ? std::max(0, one.solver) : 0, one.friction, one.restitution};
    }
    const auto& one = static_cast<const DebrisBody&>(solid);
    return {one.asleep ? 0 : one.solver, one.friction, one.restitution};
  };
  const PairEnds& ends = pairs_.ends(index);
  const Solid &first = *pairs_.collider(ends.first).solid, &second = *pairs_.collider(ends.second).solid;
  const Side a = side(first), b = side(second);
  SolverContact contact;
  contact.pair = &pairs_.pair(index);
  contact.first = a.number;
  contact.second = b.number;
  contact.first_at = &placement(first);
  contact.second_at = &placement(second);
  contact.friction = std::sqrt(a.friction * b.friction);
  contact.restitution = std::sqrt(a.restitution * b.restitution);
  return contact;
}

void DebrisWorld::add_contacts(const Island& island) {
  const std::span<SolverContact> made = solver_.add_contacts(island.pairs.size());
  region_.each(made.size(), kPairs, [&](std::size_t i) { made[i] = solver_contact(island.pairs[i]); });
  for (DebrisHinge* hinge : island.hinges) {
    hinge->rows.body = body(hinge->body).solver;
    hinge->rows.holder = hinge->other < 0 ? 0 : body(hinge->other).solver;
    solver_.add(&hinge->rows);
  }
  for (DebrisCable* cable : island.cables) {
    cable->row.body = body(cable->body).solver;
    cable->row.impulse.setZero();
    cable->row.pulled = 0;
    solver_.add(&cable->row);
  }
}

template <class Work>
void DebrisWorld::each_solved(const Work& work) {
  region_.each(solving_.size(), kBodies, [&](std::size_t i) { work(*solving_[i]); });
}

void DebrisWorld::solve(std::span<Island* const> islands, int substeps, double dt) {
  fill_solver(islands, dt, substeps);
  each_solved([&](DebrisBody& one) {
    one.substep_rate = substeps / dt;
    one.velocity_before = one.velocity;
    one.spin_before = one.spin;
    one.energy_before = energy(one, dt);
  });
  solver_.run(dt, substeps);
  tell_contacts(dt);  // where things were when the step began
  press_moving(dt);
  take_results(dt);
  account_work(islands, dt);
  if (awake_count_ < order_.size())
    for (const SolverContact& solved : solver_.contacts()) impulses_.emplace_back(solved.pair, solved.impulse);
}

void DebrisWorld::take_results(double dt) {
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
      if (DebrisBody* one = moving(contact, second)) one->load = std::max(one->load, contact.load);
  resist_rolling();
  each_solved([&](DebrisBody& one) { turn(one, solver_.body(one.solver).turned, dt); });
}

/// A ball on soil: by the normal force times a share of its radius.
void DebrisWorld::resist_rolling() {
  for (const SolverContact& contact : solver_.contacts())
    for (const bool second : {false, true}) {
      DebrisBody* ball = moving(contact, second);
      if (!ball || ball->ball_radius == 0) continue;
      const double pressed = std::abs(contact.impulse.dot(contact.pair->manifold.normal)), spin = ball->spin.norm();
      const double slowed = settings_.rolling_resistance * ball->ball_radius * pressed / ball->moments.x();
      if (spin > 0) ball->spin *= std::max(0.0, spin - slowed) / spin;
    }
}

}  // namespace topple::collision
