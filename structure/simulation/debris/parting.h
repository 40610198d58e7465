#pragma once
// A part of what stands that breaks off while a body pushes it. Within its substep the body pushed it as the structure
// held it then, by more than the free part takes: what that gave it beyond the speed at which the two part (Newton's
// law of restitution) goes back to the body.
#include <span>

#include "simulation/debris/debris.h"

namespace topple::structure {

/// One contact of a substep.
struct PartingContact {
  collision::Contact contact;
  Part part;
  Vec3 velocity = Vec3::Zero();  ///< of the part at the contact's point before the substep, m/s
};

/// Of those whose part is a body now: opposite impulses on both at the contact's point, along its normal and never more
/// than it pushed, until none parts faster than `restitution` allows. What they take out of the motion, J.
[[nodiscard]] double limit_parting(Debris& debris, std::span<const PartingContact> contacts, double restitution);

}  // namespace topple::structure
