#pragma once
// Edges of shell panels whose joint has `stiffness`: the panel's side of a joint moves against the nodes that it hangs
// on, freely where the joint is released, against a spring where it has one, not at all elsewhere.
#include "topple/solver/jointed_shell.h"
#include "topple/solver/static_analysis.h"
#include "topple/structure/frame.h"

namespace topple::structure {

/// To be called last, when members are divided and edges supported. Each mesh node at which such a joint gives gets a
/// node for the panel's side, whose six freedoms are its motion against the node on the other side in axes of its own:
/// those that the joint holds are supports, so that they are held exactly, and its elements become patches in these
/// freedoms. PanelMesh names the nodes of the panel's side from then on.
void add_semi_rigid_edges(const Building& building, Frame& frame);

/// The element of that shell, or null where its corners do not give.
[[nodiscard]] const SemiRigidElement* semi_rigid_element(const Frame& frame, int shell);

/// The elements whose corners give, for what acts on displaced nodes and for masses.
[[nodiscard]] std::vector<solver::JointedShell> jointed_shells(const Frame& frame);

/// Motions of the panel's sides as those of other nodes: global, against the ground.
void make_absolute(const Frame& frame, std::vector<Vec6>& displacements);
/// The same for a shape, whose largest translation is 1 afterwards too.
void make_shape_absolute(const Frame& frame, std::vector<Vec6>& shape);

/// Loads of an element whose side gives, as forces on its nodes; zero of `traction` and `strain` adds nothing.
void add_element_loads(const Frame& frame, const SemiRigidElement& element, const Vec3& traction, double strain,
                       solver::LoadSet& set);

/// Forces of its nodes on such an element, global. `solution`: with absolute displacements.
[[nodiscard]] std::array<Vec6, 4> element_corner_forces(const Frame& frame, const SemiRigidElement& element,
                                                        const solver::StaticSolution& solution, const Vec3& traction,
                                                        double strain);

/// The loads without those on the panels' sides, which act on the other side as well, and likewise the reactions.
void leave_out_semi_rigid_sides(const Frame& frame, solver::LoadSet& loads, std::vector<Vec6>& reactions);

}  // namespace topple::structure
