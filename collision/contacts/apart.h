#pragma once
// Pairs that need no search for their first touch: a face of one keeps them apart over the whole duration, or lets them
// meet only slowly.
#include "contacts/first_touch.h"
#include "shapes/touching_solid.h"

namespace topple::collision {

/// A part on its way: where its solid is at both ends of the duration, and the motion between.
struct MovingPart {
  const TouchingSolid& solid;
  std::size_t part;
  const Motion& motion;
  Placement end;
};

/// How two parts come together within the duration: not at all; only slowly; or it takes a search to know.
enum class Meeting { never, slow, unknown };

/// Never: all corners of the one stay outside of a face of the other, which for convex parts is proof, whatever slides
/// along it. Slow: across the face that is farthest from the other at the start they close by less than `least_speed`
/// (m/s). Unknown for balls, and where edges cross. `duration` in s.
[[nodiscard]] Meeting meeting_of(const MovingPart& first, const MovingPart& second, double duration,
                                 double least_speed);

}  // namespace topple::collision
