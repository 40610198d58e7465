#pragma once
// The cross product in the plane.
#include "topple/fracture/polygon.h"

namespace topple::fracture {

/// The area that two vectors span: positive where the second one lies counter-clockwise of the first.
[[nodiscard]] inline double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

}  // namespace topple::fracture
