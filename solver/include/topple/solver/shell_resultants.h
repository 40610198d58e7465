#pragma once
#include <vector>

#include "topple/solver/frame_model.h"

namespace topple::solver {

/// Stress resultants per length at a place of a shell. Axes: x from its first node to its second, z the normal by the
/// right hand round the nodes, y = z x x.
struct ShellResultants {
  Vec3 membrane = Vec3::Zero();  ///< nx, ny, nxy; tension positive
  Vec3 moments = Vec3::Zero();   ///< mx, my, mxy: integrals of stress times z, so tension at +z is positive
  Eigen::Vector2d shears = Eigen::Vector2d::Zero();  ///< qx, qy on faces that look along +x, +y, positive along +z
};

/// From node displacements (global); `strain` is the free in-plane strain that the load set gave it. `at`: natural
/// coordinates, -1 to 1 from its first node towards the second and the fourth; the centre is where they are most exact.
[[nodiscard]] ShellResultants shell_resultants(const FrameModel& model, int shell,
                                               const std::vector<Vec6>& displacements, double strain = 0,
                                               const Eigen::Vector2d& at = Eigen::Vector2d::Zero());

}  // namespace topple::solver
