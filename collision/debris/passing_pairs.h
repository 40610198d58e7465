#pragma once
// Pairs that pass each other. Contacts are planes, which reach farther than what they belong to: what goes past an edge
// goes through its plane, and the plane of an edge turns as something comes near. Where the sweep, and so the law of
// impact, sees no touch within a step, nothing may be pushed in it.
#include <cstdint>

#include "debris/debris_scene.h"

namespace topple::collision {

/// Whether the pair's contacts would push within `dt`, as the two move, though they do not touch yet.
[[nodiscard]] bool may_push(const DebrisScene& scene, std::uint32_t pair, double dt);
/// For a pair that may_push(): unless the two do touch on their paths, its points lie so far apart that they do not
/// push. What changes the paths within the step is held up by them all the same.
void clear_if_passing(DebrisScene& scene, std::uint32_t pair, double dt);

}  // namespace topple::collision
