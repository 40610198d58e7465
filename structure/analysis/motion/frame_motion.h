#pragma once
// A building's frame through time, and the peaks of what it feels.
#include <memory>

#include "analysis/damaged_frame.h"
#include "analysis/motion/motion_peaks.h"
#include "topple/structure/motion.h"

namespace topple::structure {

/// What sets a frame in motion.
struct MotionStart {
  std::vector<Vec6> displacements;  ///< per node of the frame: where it is held to begin with
  double held_over = 0;             ///< s through which what holds it there goes evenly; 0: at once
  std::vector<Vec6> rest;           ///< the static state under the loads that stay
  const TimeHistory* history = nullptr;
};

class FrameMotion {
 public:
  /// `divided` and `frame` must outlive this, and the frame stay as it is. `whole`: the building as it was given.
  FrameMotion(const Building& whole, const DividedBuilding& divided, const DamagedFrame& frame,
              CombinationId combination, const MotionRequest& request);

  /// The substep is halved until no peak changes by more than settled_peak. Without amplifications. Throws
  /// std::runtime_error when the lowest mode is not found, InputError where nothing has mass.
  [[nodiscard]] MotionResult run(const MotionStart& start) const;

 private:
  /// By the substep and the duration of `result`, which is told what did not settle.
  [[nodiscard]] std::unique_ptr<MotionPeaks> follow(const MotionStart& start, MotionResult& result,
                                                    const solver::RayleighDamping& damping) const;
  [[nodiscard]] double lowest_frequency() const;
  void load(solver::FrameDynamics& frame) const;
  [[nodiscard]] std::vector<int> add_history(const TimeHistory& history, solver::FrameDynamics& frame) const;
  [[nodiscard]] std::vector<JointId> joints_of_divided() const;

  const Building& whole_;
  const DividedBuilding& divided_;
  const DamagedFrame& frame_;
  const MotionRequest& request_;
  MovingFrame moving_;
};

}  // namespace topple::structure
