#pragma once
// The peaks of a motion: within each substep every force and displacement is the cubic of time that its values and
// rates at both ends make.
#include <vector>

#include "analysis/damaged_frame.h"
#include "topple/structure/motion.h"

namespace topple::structure {

class MotionPeaks {
 public:
  /// Begins with the state that the frame is in. `joints`: of the divided building, those whose history is wanted.
  MotionPeaks(const DividedBuilding& divided, const DamagedFrame& frame, const MotionRequest& request,
              std::vector<JointId> joints, solver::FrameDynamics& motion);
  /// After each substep.
  void sample(const solver::FrameDynamics& motion);

  [[nodiscard]] std::vector<double> uses() const;
  /// Sizes of the nodes' translations, component by component.
  [[nodiscard]] std::vector<double> movements() const;
  void write_to(const Building& whole, MotionResult& result) const;

 private:
  struct JointState {
    JointId joint;  ///< of the divided building
    Utilisation utilisation;
    Vec6 demand = Vec6::Zero();
    double at = 0;
  };
  struct State {
    std::vector<Vec6> demand, rate;
    std::vector<solver::Vec12> forces, force_rates;
    std::vector<Vec6> displacements, velocities;
  };
  void read(const solver::FrameDynamics& motion, State& state) const;
  void sample_joints(double length);
  void sample_members(double length);
  void sample_nodes(double length);
  void sample_now();

  const DividedBuilding& divided_;
  const DamagedFrame& frame_;
  const MotionRequest& request_;
  std::vector<JointId> wanted_;
  double time_ = 0;
  State before_, now_;
  mutable std::vector<JointId> holding_;
  std::vector<JointState> joints_;
  std::vector<MemberMotion> members_;
  std::vector<Vec6> largest_;
  std::vector<MotionSample> history_;
};

}  // namespace topple::structure
