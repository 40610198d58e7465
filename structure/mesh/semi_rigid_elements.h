#pragma once
// Elements along edges of shell panels that give (semi_rigid_edges.h): how their corners move, what acts on them and
// what they bear.
#include <array>
#include <utility>
#include <vector>

#include "topple/solver/jointed_shell.h"
#include "topple/solver/static_analysis.h"
#include "topple/structure/frame.h"

namespace topple::structure {

/// Nodes of an element's patch (those that it hangs on, then its own sides), and the displacements of its corners by
/// their freedoms: those of the rigid ends and the motions against them.
[[nodiscard]] std::pair<std::vector<int>, Eigen::MatrixXd> corners_by_freedoms(const Frame& frame,
                                                                               const SemiRigidElement& element);

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
