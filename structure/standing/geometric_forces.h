#pragma once
// What an axial force does to a member that has moved: the geometric stiffness of the cubic shape functions times the
// displacements of its ends (Przemieniecki, Theory of Matrix Structural Analysis, ch. 15). Where an end gives in a
// plane (a pin, a spring), the rigid end's rotation is not the member's: there the straight chord alone counts, N (v2 -
// v1)/L.
#include "topple/solver/frame_model.h"

namespace topple::structure {

/// Forces of the rigid ends on the member, local axes, beside those of its elastic stiffness. `axial`: tension
/// positive; `rigid_ends`: displacements of the rigid ends at its ends, local axes.
[[nodiscard]] solver::Vec12 geometric_forces(const solver::Beam& beam, double axial, const solver::Vec12& rigid_ends);

/// Displacements of the rigid ends at the member's ends, local axes, from those of its nodes.
[[nodiscard]] solver::Vec12 rigid_ends_of(const solver::Beam& beam, const solver::Vec6& first,
                                          const solver::Vec6& second);

/// Of local end forces on the two nodes of the member, global axes, rigid arms included.
[[nodiscard]] solver::Vec12 forces_at_nodes(const solver::Beam& beam, const solver::Vec12& end_forces);

}  // namespace topple::structure
