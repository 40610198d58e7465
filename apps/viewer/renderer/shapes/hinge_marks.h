#pragma once
// Marks of joints that have turned beyond what is elastic.
#include "renderer/instances/instance_batch.h"

namespace topple::viewer {

/// Where a drawn member's axis is at this share of its length, bent as the shader bends it.
[[nodiscard]] glm::vec3 drawn_axis(const MemberInstance& member, float share);

/// An instance of sphere_mesh() on the axis beside the member's end (0 or 1): about as far from it as the section is
/// high, so that marks of members that meet do not lie in one place. It grows with the share of the rotation that the
/// joint holds: from 0.6 to 1.2 of the section's larger side as its radius.
[[nodiscard]] RigidInstance hinge_mark(const MemberInstance& member, const structure::Section& section, int end,
                                       double share, Rgba colour);

}  // namespace topple::viewer
