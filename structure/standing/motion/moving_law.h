#pragma once
// The law of the joints of a component that moves: capacities as the building has them; it keeps the largest
// utilisations.
#include <span>
#include <vector>

#include "standing/motion/motion_sources.h"
#include "topple/solver/frame_dynamics.h"

namespace topple::structure {

class MovingLaw : public solver::JointLaw {
 public:
  /// All must outlive it.
  MovingLaw(const MotionSources& sources, int component)
      : from_(sources), members_(sources.statics.members(component)) {}

  [[nodiscard]] double beam_utilisation(int beam, const solver::Vec12& forces) const override;
  /// Throws std::runtime_error where it is not finite.
  [[nodiscard]] double end_utilisation(int beam, int end, const solver::Vec12& forces) const override;
  [[nodiscard]] std::span<const solver::PlasticHinge> plastic_hinges() const override { return hinges_; }
  /// As they are in the component now.
  void set_hinges(std::vector<solver::PlasticHinge> hinges) { hinges_ = std::move(hinges); }

 private:
  MotionSources from_;
  const std::vector<MemberId>& members_;
  std::vector<solver::PlasticHinge> hinges_;
};

}  // namespace topple::structure
