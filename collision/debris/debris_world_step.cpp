// The step: bounds, contacts, islands, sub-steps, what it did.
#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include "debris/body_motion.h"
#include "debris/debris_world.h"

namespace topple::collision {

namespace {
/// Fewer are not worth the ten microseconds that helpers take to come.
constexpr std::size_t kContactsShared = 100, kPairsShared = 500;

int substeps(const Island& island, const SolverSettings& settings, double dt) {
  constexpr double reference = 1.0 / 60, weight = 9.81;
  const double steps = dt / reference;
  const double for_load =
      settings.substeps_for_weight * std::pow(std::max(1.0, island.load / weight), settings.substeps_growth);
  // A stack that lands goes on into itself until the impact has come through all of it, one contact each pass.
  double mass = 0, energy = 0;
  for (const DebrisBody* one : island.bodies) {
    mass += one->mass;
    energy += one->mass * one->velocity.squaredNorm();
  }
  const double for_speed = std::sqrt(energy / mass) * reference / settings.substep_way;
  const double wanted =
      std::clamp(std::max(for_load, for_speed), double(settings.fewest_substeps), double(settings.most_substeps)) *
      steps;
  // Few different numbers, so that islands can be solved together.
  int count = 1;
  while (count < wanted) count += std::max(1, count / 4);
  // Each change of their number changes the springs: it follows a rising load at once, a falling one late.
  const int last = static_cast<int>(std::lround(island.substep_rate * dt));
  return count < last && wanted > settings.substeps_held * last ? last : count;
}
}  // namespace

void DebrisWorld::begin_step(double dt) {
  if (!(dt > 0) || !std::isfinite(dt))
    throw std::invalid_argument("step of " + std::to_string(dt) + " s; it must be above zero");
  ignored_.begin_step(dt);
  report_.clear();
  if (scene_.awake_count == 0) return;
  ++scene_.step_number;
  for (auto& [id, hinge] : scene_.hinges)
    if (!scene_.body(hinge->body).asleep) hinge->forget_step();
  for (auto& [id, cable] : scene_.cables)
    if (!scene_.body(cable->body).asleep) cable->pull = {};
}

void DebrisWorld::step(double dt) { advance(dt, 1, nullptr); }

void DebrisWorld::step(double dt, int parts, MovingStructure& structure) {
  if (parts < 1) throw std::invalid_argument("a step of " + std::to_string(parts) + " parts; it has at least one");
  advance(dt, parts, &structure);
}

/// In `parts` after each of which the structure goes on, and each of those in as many as the spins that it begins with
/// need, whatever the length of the step. Without a structure obstacles stand still.
void DebrisWorld::advance(double dt, int parts, MovingStructure* structure) {
  const double part_time = dt / parts;
  if (structure) {
    update_moving(part_time, *structure);
    search_.find_touching();
    moving_.wake_carried();
  }
  begin_step(dt);
  while (!structure && !scene_.moving_obstacles.empty())
    moving_.stand_still(scene_.obstacle(scene_.moving_obstacles.back()));
  if (!structure && scene_.awake_count == 0) return;
  find_contacts(part_time);
  gather_islands();
  parts_ = 1;
  if (parts_for_spins(part_time) == 1 && rest_.fall_asleep(islands_, dt)) gather_islands();
  for (int part = 0; part < parts; ++part) {
    const std::size_t told = report_.all().size();
    if (part > 0) update_moving(part_time, *structure);
    int finer = 1;
    for (int i = 0; i < finer && (scene_.awake_count > 0 || !scene_.moving_obstacles.empty()); ++i) {
      if (part + i > 0) find_contacts(i == 0 ? part_time : dt / parts_);
      if (i == 0) {
        finer = parts_for_spins(part_time);
        parts_ = parts * finer;
        read_velocities_by(scene_.gravity * ((1 - 1.0 / parts_) * dt / 2));
      }
      if (part + i > 0) gather_islands();
      if (scene_.awake_count > 0) move_on(dt / parts_);
    }
    if (structure) advance_structure(part_time, told, *structure);
  }
  read_velocities_by(Vec3::Zero());
  rest_.end_step(dt);
  report_.merge_parts();
}

void DebrisWorld::update_moving(double dt, MovingStructure& structure) {
  search_.update_bounds(dt);
  search_.find_near();
  moving_.update(dt, structure);
}

/// To the structure, what touched it since contact number `told`; it goes on.
void DebrisWorld::advance_structure(double dt, std::size_t told, MovingStructure& structure) {
  const std::vector<Contact> own(report_.all().begin() + static_cast<std::ptrdiff_t>(told), report_.all().end());
  stepping_ = true;
  structure.advance(dt, own, moving_.extract_pulls());
  stepping_ = false;
}

/// One part of a step, once contacts and islands are found.
void DebrisWorld::move_on(double dt) {
  std::map<int, std::vector<Island*>> by_substeps;
  for (Island& island : islands_) {
    if (island.pairs.empty() && island.hinges.empty() && island.cables.empty())
      fly(*island.bodies.front(), scene_.gravity, dt);
    else
      by_substeps[substeps(island, scene_.settings, dt)].push_back(&island);
  }
  const auto solve_all = [&] {
    for (const auto& [count, islands] : by_substeps) solve(islands, count, dt);
  };
  pushes_.clear();
  scene_.touching.size() >= kContactsShared ? region_.run(solve_all) : solve_all();
  waking_.wake_changed(pushes_, dt);
  rest_.watch(islands_, dt);
}

/// Contacts are planes at points that stay through `dt`. A body that spins leaves them by reach (1 - cos(w dt)): it is
/// taken in so many parts, each with contacts of its own, that this is small for all that touch.
int DebrisWorld::parts_for_spins(double dt) const {
  double most = 0;
  const auto look_at = [&](std::uint32_t collider) {
    const Solid& solid = *scene_.pairs.collider(collider).solid;
    if (solid.kind != Touched::Kind::body) return;
    const auto& one = static_cast<const DebrisBody&>(solid);
    if (one.asleep || one.ball_radius > 0) return;
    if (one.reach * one.spin.squaredNorm() * dt * dt < most) return;  // 1 - cos(a) is at most half of a^2
    const double angle = std::min(M_PI, one.spin.norm() * dt);
    most = std::max(most, one.reach * (1 - std::cos(angle)));
  };
  for (const std::uint32_t index : scene_.touching) {
    const PairEnds& ends = scene_.pairs.ends(index);
    look_at(ends.first);
    if (ends.second != NearPairs::ground) look_at(ends.second);
  }
  return std::clamp(static_cast<int>(std::ceil(std::sqrt(most / scene_.settings.leaves_plane))), 1,
                    scene_.settings.most_parts);
}

/// Stored velocities are those of the middle of a step; in its parts, those of the middle of a part: this much more.
void DebrisWorld::read_velocities_by(const Vec3& more) {
  for (const BodyId id : scene_.order)
    if (DebrisBody& one = scene_.body(id.value); !one.asleep) one.velocity += more - scene_.reading;
  scene_.reading = more;
}

void DebrisWorld::find_contacts(double dt) {
  const auto find = [&] {
    scene_.wake_hinged();
    search_.update_bounds(dt);
    search_.find_near();
    search_.note_ways(dt);
    search_.seek_contacts(dt);
    search_.find_touching();
    moving_.wake_carried();
    waking_.wake_struck(dt);
  };
  scene_.pairs.order().size() >= kPairsShared ? region_.run(find) : find();
}

void DebrisWorld::gather_islands() {
  std::vector<DebrisBody*> awake;
  for (const BodyId id : scene_.order)
    if (DebrisBody& one = scene_.body(id.value); !one.asleep) awake.push_back(&one);
  std::vector<IslandParts::Hung> hung;
  for (auto& [id, hinge] : scene_.hinges)
    if (DebrisBody& one = scene_.body(hinge->body); !one.asleep)
      hung.push_back(
          {hinge.get(), &one, hinge->other >= 0 ? &scene_.body(hinge->other) : nullptr, scene_.moving_holder(*hinge)});
  std::vector<IslandParts::Tied> tied;
  for (auto& [id, cable] : scene_.cables)
    if (DebrisBody& one = scene_.body(cable->body); !one.asleep) tied.push_back({cable.get(), &one});
  for (const std::int64_t id : scene_.moving_obstacles) scene_.obstacle(id).island = -1;
  islands_ = find_islands({scene_.pairs, scene_.touching, awake, hung, tied, scene_.settings.carries_from});
}

void DebrisWorld::solve(std::span<Island* const> islands, int substeps, double dt) {
  solved_.fill(islands, dt, substeps);
  solved_.run(dt, substeps);
  report_.add(solved_.solver().contacts(), dt);
  moving_.read_motion(solved_.solver(), islands, dt);
  solved_.update_bodies(dt);
  report_.account_work(islands, dt);
  solved_.read_joints(islands, dt * parts_);
  if (!scene_.all_awake())
    for (const SolverContact& solved : solved_.solver().contacts()) pushes_.push_back({solved.pair, solved.impulse});
}

}  // namespace topple::collision
