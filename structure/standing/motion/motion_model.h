#pragma once
// A component of what stands as a model that can move: as its statics have it now, with its masses and loads. What has
// left is held, and touches nothing: it has no part in the motion.
#include <vector>

#include "standing/motion/motion_masses.h"
#include "standing/motion/motion_sources.h"
#include "topple/solver/frame_dynamics.h"

namespace topple::structure {

class MotionModel {
 public:
  /// All must outlive it.
  MotionModel(const MotionSources& sources, const MotionMasses& masses) : from_(sources), masses_(masses) {}

  /// Members have their mass as density, shell panels as the mass of their patch.
  [[nodiscard]] solver::FrameModel frame(int component) const;
  /// What lies on nodes.
  [[nodiscard]] solver::MassModel node_masses(int component) const;
  /// Per node, as solved last; zero where it is no part of the component any more.
  [[nodiscard]] std::vector<Vec6> at_rest(int component) const;
  /// Loads, softened members, and hinges as they have turned so far, on such a frame.
  void lay_on(int component, solver::FrameDynamics& frame) const;
  /// Of a shell panel: by its weight; without any by its material's.
  [[nodiscard]] double kilograms(PanelId shell) const;
  /// The same in the freedoms of its nodes.
  [[nodiscard]] Eigen::MatrixXd mass(PanelId shell) const;

 private:
  MotionSources from_;
  const MotionMasses& masses_;
};

}  // namespace topple::structure
