#pragma once
// From the solution of the equations back to nodes, beams and supports.
#include <array>
#include <span>
#include <vector>

#include "assembly/frame_system.h"

namespace topple::solver {

/// Per node, from the displacements of the equations (not scaled) and those of held freedoms.
[[nodiscard]] std::vector<Vec6> node_displacements(const FrameElements& frame, const Eigen::VectorXd& displacement,
                                                   const Eigen::VectorXd& held);
/// A vector of scaled equations as a shape: its largest translation 1 (rotation, where nothing translates), and the
/// first component of that size positive.
[[nodiscard]] std::vector<Vec6> normalised_shape(const FrameSystem& system, const Eigen::VectorXd& scaled);
/// Displacements, forces and reactions of several right-hand sides, the solution of each (not scaled) in a column.
/// Their quality is left to the caller. The loads' `beam_fixed_end` are used up.
[[nodiscard]] std::vector<StaticSolution> recover_solutions(const FrameSystem& system, std::span<LoadVector> loads,
                                                            const Eigen::MatrixXd& displacements, int threads = 1);
/// Per support: what it does to the structure.
[[nodiscard]] std::vector<Vec6> support_reactions(const FrameSystem& system, const std::vector<Vec6>& displacements,
                                                  const std::vector<Vec12>& beam_end_forces,
                                                  const std::vector<std::array<Vec6, 4>>& shell_corner_forces,
                                                  const std::vector<Vec6>& node_loads);

}  // namespace topple::solver
