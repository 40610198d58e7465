#pragma once
// The motion of a frame at one time.
#include <Eigen/Core>
#include <vector>

#include "topple/solver/frame_model.h"

namespace topple::solver {

/// Of the scaled equations.
struct MotionState {
  Eigen::VectorXd u, v, a;
};

/// The same by nodes, global.
struct NodeMotion {
  std::vector<Vec6> u, v;
};

}  // namespace topple::solver
