// Bodies that touch or hang together, and in how many sub-steps they are solved.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "solver/debris_world.h"

namespace topple::collision {

/// Of bodies that touch or hang together, or touch the same obstacle that moves. What stands still, or sleeps, joins
/// none.
void DebrisWorld::gather_islands() {
  std::vector<DebrisBody*> awake_bodies;
  for (const BodyId id : order_) {
    DebrisBody& one = body(id.value);
    if (one.asleep) continue;
    one.island = static_cast<int>(awake_bodies.size());
    awake_bodies.push_back(&one);
  }
  std::vector<int> parent(awake_bodies.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](int i) {
    while (parent[static_cast<std::size_t>(i)] != i)
      i = parent[static_cast<std::size_t>(i)] = parent[static_cast<std::size_t>(parent[static_cast<std::size_t>(i)])];
    return i;
  };
  const auto join = [&](const DebrisBody& a, const DebrisBody& b) {
    const int first = root(a.island), second = root(b.island);
    parent[static_cast<std::size_t>(std::max(first, second))] = std::min(first, second);
  };
  const auto moves = [&](std::uint32_t collider) -> DebrisBody* {
    Solid* solid = pairs_.collider(collider).solid;
    if (solid->kind != Touched::Kind::body) return nullptr;
    auto* one = static_cast<DebrisBody*>(solid);
    return one->asleep ? nullptr : one;
  };
  for (const std::int64_t id : moving_obstacles_) obstacle(id).island = -1;
  for (const std::uint32_t index : touching_) {
    const NearPair& pair = pairs_.pair(index);
    DebrisBody *a = moves(pair.first), *b = moves(pair.second);
    if (a && b) join(*a, *b);
    Solid* const second = pairs_.collider(pair.second).solid;
    if (!a || second->kind != Touched::Kind::obstacle || !static_cast<DebrisObstacle*>(second)->moves) continue;
    int& first = static_cast<DebrisObstacle*>(second)->island;
    if (first < 0)
      first = a->island;
    else
      join(*a, *awake_bodies[static_cast<std::size_t>(first)]);
  }
  for (auto& [id, hinge] : hinges_)
    if (hinge->other >= 0 && !body(hinge->body).asleep) join(body(hinge->body), body(hinge->other));
  std::vector<int> number(awake_bodies.size(), -1);
  islands_.clear();
  for (DebrisBody* one : awake_bodies) {
    const auto top = static_cast<std::size_t>(root(one->island));
    if (number[top] < 0) {
      number[top] = static_cast<int>(islands_.size());
      islands_.emplace_back();
    }
  }
  for (DebrisBody* one : awake_bodies) {
    one->island = number[static_cast<std::size_t>(root(one->island))];
    Island& island = islands_[static_cast<std::size_t>(one->island)];
    island.bodies.push_back(one);
    island.load = std::max(island.load, one->load);
    island.substep_rate = std::max(island.substep_rate, one->substep_rate);
  }
  const auto island_of = [&](const DebrisBody& one) -> Island& {
    return islands_[static_cast<std::size_t>(one.island)];
  };
  for (const std::uint32_t index : touching_) {
    const NearPair& pair = pairs_.pair(index);
    const DebrisBody *a = moves(pair.first), *b = moves(pair.second);
    if (!a && !b) continue;
    Island& island = island_of(a ? *a : *b);
    island.pairs.push_back(index);
    if (const DebrisObstacle* carrier = moving_obstacle(pair))
      island.carried = island.carried || carrier->speed() > settings_.carries_from;
  }
  for (auto& [id, hinge] : hinges_)
    if (!body(hinge->body).asleep) island_of(body(hinge->body)).hinges.push_back(hinge.get());
  for (auto& [id, cable] : cables_)
    if (!body(cable->body).asleep) island_of(body(cable->body)).cables.push_back(cable.get());
}

int DebrisWorld::substeps(const Island& island, double dt) const {
  constexpr double reference = 1.0 / 60, weight = 9.81;
  const double steps = dt / reference;
  const double for_load =
      settings_.substeps_for_weight * std::pow(std::max(1.0, island.load / weight), settings_.substeps_growth);
  // A stack that lands goes on into itself until the blow has come through all of it, one contact each pass.
  double mass = 0, energy = 0;
  for (const DebrisBody* one : island.bodies) {
    mass += one->mass;
    energy += one->mass * one->velocity.squaredNorm();
  }
  const double for_speed = std::sqrt(energy / mass) * reference / settings_.substep_way;
  const double wanted =
      std::clamp(std::max(for_load, for_speed), double(settings_.fewest_substeps), double(settings_.most_substeps)) *
      steps;
  // Few different numbers, so that islands can be solved together.
  int count = 1;
  while (count < wanted) count += std::max(1, count / 4);
  // Each change of their number changes the springs: it follows a rising load at once, a falling one late.
  const int last = static_cast<int>(std::lround(island.substep_rate * dt));
  return count < last && wanted > settings_.substeps_held * last ? last : count;
}

}  // namespace topple::collision
