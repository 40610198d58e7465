#pragma once
// The reduction of many points of contact to the four of a manifold.
#include <vector>

#include "contacts/manifold.h"

namespace topple::collision {

/// Keeps at most four of the points: the deepest, and those that span the most. `places`: where each is, in any frame
/// that `normal` is given in. Both lists are used up.
void reduce_to_four(const Vec3& normal, std::vector<ManifoldPoint>& points, std::vector<Vec3>& places,
                    Manifold& manifold);

}  // namespace topple::collision
