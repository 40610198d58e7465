#pragma once
// A collision::World with a contact solver of our own: soft contacts in small steps (docs/rooms/contact-solvers.md).
// Forces are the sums of what was applied, so that they balance weight and momentum to rounding; what sleeps presses
// with forces in balance. Contacts of bodies that come to rest are told in that step, and not after.
#include "topple/collision/world.h"

namespace topple::collision {

/// An island rests when all of its bodies have been slow for half a second and forces within their friction cones hold
/// each of them.
[[nodiscard]] std::unique_ptr<World> make_small_steps_world();

}  // namespace topple::collision
