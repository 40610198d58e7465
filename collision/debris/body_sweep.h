#pragma once
// The sweep: first touches of awake bodies within a step, on the paths that they have now. It moves nothing.
#include <optional>
#include <span>
#include <vector>

#include "debris/ignored_pairs.h"

namespace topple::collision {

/// Whether the two meet within this step of `dt` or the next, faster than what rests does: one that is about to go
/// through the other. (This step alone would not do: who is told at the end of a step to pass has yet to arrive.)
[[nodiscard]] bool still_to_pass(const DebrisScene& scene, const DebrisBody& first, const Solid& other, double dt);

/// First touches within `dt`, each pair of parts once, the body with the lower id first. In no order.
[[nodiscard]] std::vector<Contact> first_touches(const DebrisScene& scene, const IgnoredPairs& ignored, double dt,
                                                 const SweepOptions& options);

}  // namespace topple::collision
