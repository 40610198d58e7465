// Of what islands are found, and in how many sub-steps they are solved.
#include <algorithm>
#include <cmath>

#include "debris/debris_world.h"

namespace topple::collision {

void DebrisWorld::gather_islands() {
  std::vector<DebrisBody*> awake;
  for (const BodyId id : order_)
    if (DebrisBody& one = body(id.value); !one.asleep) awake.push_back(&one);
  std::vector<IslandParts::Hung> hung;
  for (auto& [id, hinge] : hinges_)
    if (DebrisBody& one = body(hinge->body); !one.asleep)
      hung.push_back({hinge.get(), &one, hinge->other >= 0 ? &body(hinge->other) : nullptr});
  std::vector<IslandParts::Tied> tied;
  for (auto& [id, cable] : cables_)
    if (DebrisBody& one = body(cable->body); !one.asleep) tied.push_back({cable.get(), &one});
  for (const std::int64_t id : moving_obstacles_) obstacle(id).island = -1;
  islands_ = find_islands({pairs_, touching_, awake, hung, tied, settings_.carries_from});
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
