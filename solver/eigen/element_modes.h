#pragma once
// The motions in which an element strains, as columns over the scaled equations: K of the element = B D B' in any state
// of its ends and releases, with the same B. So whatever happens to a beam is a change of rank 6 at most.
#include <Eigen/Core>
#include <vector>

#include "assembly/frame_system.h"

namespace topple::solver {

struct ElementModes {
  std::vector<int> rows;  ///< equations; one may come twice (two freedoms in one diaphragm)
  Eigen::MatrixXd B;      ///< a row for each
  template <class Archive>
  void serialize(Archive& archive) {
    auto& [equations, motions] = *this;
    archive(equations, motions);
  }
};

/// What the second end moves beyond the rigid motion of the first, along the beam's axes: 6 columns. With inertia every
/// motion counts: a column for each of its freedoms that is an equation.
[[nodiscard]] ElementModes beam_modes(const FrameSystem& system, int beam);
/// D of a beam as it stands: its stiffness at the second end with the first held; with inertia K + factor M in its
/// equations. Never on the heap.
using BeamModeMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 12, 12>;
[[nodiscard]] BeamModeMatrix beam_mode_stiffness(const FrameSystem& system, int beam);

/// A shell's straining motions, scaled so that D is the identity while it stands.
[[nodiscard]] ElementModes shell_modes(const FrameSystem& system, const Mat24& stiffness, int shell);

/// A node's own equations, one column each.
[[nodiscard]] ElementModes node_modes(const FrameSystem& system, int node);

}  // namespace topple::solver
