#pragma once
// What an axial force does to a beam that has moved: the geometric stiffness of the cubic shape functions times the
// displacements of its ends (J. S. Przemieniecki, Theory of Matrix Structural Analysis, 1968, ch. 15). Where an end
// gives in a plane (a pin, a spring), the rigid end's rotation is not the beam's: there the straight chord alone
// counts, N (v2 - v1)/L. An end that holds nothing sideways or along the beam passes nothing on.
#include "topple/solver/frame_model.h"

namespace topple::solver {

/// Forces of the rigid ends on the beam, local axes, beside those of its elastic stiffness. `axial`: N, tension
/// positive; `rigid_ends`: rigid_end_displacements().
[[nodiscard]] Vec12 geometric_forces(const Beam& beam, double axial, const Vec12& rigid_ends);
/// The same of a beam that bears these elastic end forces (local), by displacements of its nodes (global).
[[nodiscard]] Vec12 geometric_forces(const Beam& beam, const Vec12& end_forces, const Vec6& first_node,
                                     const Vec6& second_node);

/// Displacements of the rigid ends at the beam's ends (after the arms), local axes, from node displacements (global).
[[nodiscard]] Vec12 rigid_end_displacements(const Beam& beam, const Vec6& first_node, const Vec6& second_node);
/// Transpose of the same: local end forces to forces on the element at its nodes, global.
[[nodiscard]] Vec12 node_forces(const Beam& beam, const Vec12& end_forces);

}  // namespace topple::solver
