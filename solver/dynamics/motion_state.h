#pragma once
// The motion of a frame at one time.
#include <Eigen/Core>
#include <vector>

#include "topple/solver/frame_model.h"

namespace topple::solver {

/// Of the scaled equations.
struct MotionState {
  Eigen::VectorXd u, v, a;
  template <class Archive>
  void serialize(Archive& archive) {
    auto& [displacements, velocities, accelerations] = *this;
    archive(displacements, velocities, accelerations);
  }
};

/// The same by nodes, global.
struct NodeMotion {
  std::vector<Vec6> u, v;
  template <class Archive>
  void serialize(Archive& archive) {
    auto& [displacements, velocities] = *this;
    archive(displacements, velocities);
  }
};

}  // namespace topple::solver
