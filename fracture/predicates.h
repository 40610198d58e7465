#pragma once
// The two questions on which a triangulation stands, answered so that rounding cannot contradict itself.
#include "topple/fracture/polygon.h"

namespace topple::fracture {

/// Twice the area of the triangle a, b, c, positive when it goes counter-clockwise. The sign is exact for any finite
/// coordinates whose products neither overflow nor underflow; the value is rounded. After J. Shewchuk, "Adaptive
/// Precision Floating-Point Arithmetic and Fast Robust Geometric Predicates" (1997): a bound on the rounding error
/// decides nearly always, an exact sum of all products the rest.
[[nodiscard]] double orientation(const Vec2& a, const Vec2& b, const Vec2& c);

/// True when d lies inside the circle through a, b, c (counter-clockwise) beyond any doubt of rounding. A doubtful case
/// is false: who flips edges by it only ever raises the triangulation towards Delaunay's and comes to an end.
[[nodiscard]] bool certainly_in_circle(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d);

/// Distance of a point from the segment from a to b.
[[nodiscard]] double distance_to_segment(const Vec2& point, const Vec2& a, const Vec2& b);

}  // namespace topple::fracture
