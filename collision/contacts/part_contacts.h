#pragma once
// Contacts of any two convex parts, and of a part with the ground.
#include "contacts/manifold.h"
#include "contacts/polyhedra_contacts.h"

namespace topple::collision {

/// Fills points and normal of what is nearer than `margin`; impulses are not touched.
void collide(const PartShape& first, const Placement& first_at, const PartShape& second, const Placement& second_at,
             double margin, SeparatingAxis& axis, Manifold& manifold);
/// With the half space below z = height, whose frame is the global one.
void collide_with_ground(const PartShape& part, const Placement& at, double height, double margin, Manifold& manifold);

}  // namespace topple::collision
