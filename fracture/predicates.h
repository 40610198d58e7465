#pragma once
// The two questions on which a triangulation stands, answered so that rounding cannot contradict itself.
#include <algorithm>
#include <cmath>

#include "topple/fracture/polygon.h"

namespace topple::fracture {

/// Half a unit in the last place of 1, the rounding error of an operation.
constexpr double kRoundoff = 0x1p-53;

/// What `orientation` falls back on: an exact sum of all products.
[[nodiscard]] double exact_orientation(const Vec2& a, const Vec2& b, const Vec2& c);

/// Twice the area of the triangle a, b, c, positive when it goes counter-clockwise. The sign is exact for any finite
/// coordinates whose products neither overflow nor underflow; the value is rounded. After J. Shewchuk, "Adaptive
/// Precision Floating-Point Arithmetic and Fast Robust Geometric Predicates" (1997): a bound on the rounding error
/// decides nearly always, an exact sum of all products the rest.
[[nodiscard]] inline double orientation(const Vec2& a, const Vec2& b, const Vec2& c) {
  const double left = (a.x() - c.x()) * (b.y() - c.y()), right = (a.y() - c.y()) * (b.x() - c.x());
  const double value = left - right;
  constexpr double bound = (3 + 16 * kRoundoff) * kRoundoff;
  if (std::abs(value) > bound * (std::abs(left) + std::abs(right))) return value;
  if (left == 0 && right == 0) return 0;  // differences have exact signs: both products are exactly zero
  return exact_orientation(a, b, c);
}

/// True when d lies inside the circle through a, b, c (counter-clockwise) beyond any doubt of rounding. A doubtful case
/// is false: who flips edges by it only ever raises the triangulation towards Delaunay's and comes to an end.
[[nodiscard]] inline bool certainly_in_circle(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  const double px = a.x() - d.x(), py = a.y() - d.y(), qx = b.x() - d.x(), qy = b.y() - d.y();
  const double rx = c.x() - d.x(), ry = c.y() - d.y();
  const double qr = qx * ry, rq = rx * qy, rp = rx * py, pr = px * ry, pq = px * qy, qp = qx * py;
  const double lift_p = px * px + py * py, lift_q = qx * qx + qy * qy, lift_r = rx * rx + ry * ry;
  const double value = lift_p * (qr - rq) + lift_q * (rp - pr) + lift_r * (pq - qp);
  if (!(value > 0)) return false;
  const double magnitude = lift_p * (std::abs(qr) + std::abs(rq)) + lift_q * (std::abs(rp) + std::abs(pr)) +
                           lift_r * (std::abs(pq) + std::abs(qp));
  constexpr double bound = (10 + 96 * kRoundoff) * kRoundoff;
  return value > bound * magnitude;
}

/// Distance of a point from the segment from a to b.
[[nodiscard]] double distance_to_segment(const Vec2& point, const Vec2& a, const Vec2& b);

/// False only when a point is farther than `distance` (above 0) from the segment from a to b, which it knows without a
/// root or a division: what nearly all points are. The factor of two between the bounds is far above any rounding.
[[nodiscard]] inline bool may_lie_within(const Vec2& point, const Vec2& a, const Vec2& b, double distance) {
  const double x = b.x() - a.x(), y = b.y() - a.y(), px = point.x() - a.x(), py = point.y() - a.y();
  const double one = x * py, other = y * px;  // their difference is the distance from the line times the length
  const double least = std::abs(one - other) - 0x1p-50 * (std::abs(one) + std::abs(other));
  return !(least > 0 && least * least > 4 * distance * distance * (x * x + y * y));
}

}  // namespace topple::fracture
