#pragma once
// Pairs that pass each other. Contacts are planes, which reach farther than what they belong to: what goes past an edge
// goes through its plane, and the plane of an edge turns as something comes near. Where the sweep, and so the law of
// impact, sees no touch within a step, nothing may be pushed in it.
#include <cstdint>

#include "debris/debris_scene.h"

namespace topple::collision {

/// Where a pair's contacts would push within `dt`, as the two move, though they do not touch yet: unless the two do
/// touch on their paths, its points lie so far apart that they do not push. What changes the paths within the step is
/// held up by them all the same. Changes nothing but that pair. The search for a touch is Bullet's, of objects of its
/// own, as Bullet's dispatcher for several threads has it.
void clear_if_passing(DebrisScene& scene, std::uint32_t pair, double dt);

}  // namespace topple::collision
