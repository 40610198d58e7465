#pragma once
// A hook on a rope that a winch pulls, and thermite.
#include "topple/structure/building.h"

namespace topple::viewer {

/// A rope from a node to a winch on the ground: its force grows evenly, in steps of 0.1 s, and stays. It lets go of
/// what comes off.
struct Pull {
  structure::NodeId node;
  structure::Vec3 winch = structure::Vec3::Zero();  ///< where it stands, m; the force has the rope's first direction
  double force = 0;                                 ///< N, at the end
  double over = 0;                                  ///< s
};
/// The increment that acts now, its number from 0; none: nothing is added at this step of the run.
inline constexpr double pull_interval = 0.1;
[[nodiscard]] inline int pull_steps(const Pull& pull) {
  const double count = pull.over / pull_interval;
  return count < 1 ? 1 : static_cast<int>(count + 0.5);
}

/// Thermite at a joint: iron melts and runs (2,500 K), and the joint is gone in ten stages.
struct Thermite {
  structure::JointId joint;
  double over = 0;  ///< s, until it is through
};

}  // namespace topple::viewer
