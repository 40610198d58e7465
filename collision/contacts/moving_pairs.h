#pragma once
// Pairs of moving bodies that may touch within a step: sweep and prune along x.
#include <algorithm>
#include <tuple>
#include <vector>

#include "contacts/swept_bounds.h"

namespace topple::collision {

/// No two points of two solids close faster than this within dt, m/s.
inline double fastest_closing(const Solid& one, const Motion& motion, const Solid& other, const Motion& other_motion,
                              double dt) {
  return (motion.velocity - other_motion.velocity).length() +
         (motion.acceleration - other_motion.acceleration).length() * dt +
         motion.angular_velocity.length() * one.reach + other_motion.angular_velocity.length() * other.reach;
}

/// Calls meet(first, second) with each pair of movers whose bounds (`whole`) meet, in order of their lower ends along
/// x; `first` is the body with the lower id. A pair that closes more slowly than `least_speed` within dt is left out,
/// and one that is not wanted(one, other), in either order.
template <class Mover, class Wanted, class Meet>
void each_moving_pair(const std::vector<Mover>& movers, double dt, double least_speed, const Wanted& wanted,
                      const Meet& meet) {
  std::vector<const Mover*> by_x;
  for (const Mover& mover : movers) by_x.push_back(&mover);
  std::sort(by_x.begin(), by_x.end(), [](const Mover* a, const Mover* b) {
    return std::make_tuple(a->whole.low.x(), a->body->id) < std::make_tuple(b->whole.low.x(), b->body->id);
  });
  for (std::size_t i = 0; i < by_x.size(); ++i) {
    for (std::size_t j = i + 1; j < by_x.size() && by_x[j]->whole.low.x() <= by_x[i]->whole.high.x(); ++j) {
      if (!wanted(*by_x[i], *by_x[j]) || !by_x[i]->whole.meets(by_x[j]->whole)) continue;
      const bool forward = by_x[i]->body->id < by_x[j]->body->id;
      const Mover &first = *by_x[forward ? i : j], &second = *by_x[forward ? j : i];
      if (!(fastest_closing(*first.body, first.motion, *second.body, second.motion, dt) < least_speed))
        meet(first, second);
    }
  }
}

}  // namespace topple::collision
