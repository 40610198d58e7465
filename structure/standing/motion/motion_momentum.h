#pragma once
// Momentum of the parts of what moves, and what becomes of that of a panel that lies otherwise. A part of a component
// at rest has none.
#include <utility>
#include <vector>

#include "standing/motion/motion_masses.h"
#include "standing/motion/motion_sources.h"
#include "topple/solver/frame_dynamics.h"

namespace topple::structure {

class StandingMotion;

class MotionMomentum {
 public:
  /// All must outlive it.
  MotionMomentum(const MotionSources& sources, const MotionMasses& masses, const StandingMotion& motion)
      : from_(sources), masses_(masses), motion_(motion) {}

  // Linear momentum (N s), and angular about the origin, of displacements about the unloaded place (N m s).
  [[nodiscard]] Vec6 of(MemberId member) const;  ///< panels that lie on it apart
  /// Its mass moved with what bore it. Once it leaves, that mass lies where the panel is, and turns as its corners do:
  /// the linear momentum is kept.
  [[nodiscard]] Vec6 of(PanelId panel) const;
  [[nodiscard]] Vec6 of(NodeId node) const;  ///< of what lies on it
  /// m/s, of the panel's mass, in the mean.
  [[nodiscard]] Vec3 velocity(PanelId panel) const;
  /// What a panel that lies on other members now brings them beyond their own velocity. Its mass has the mean velocity
  /// of what bore it, and shares it inelastically with what bears it now: linear and angular momentum are kept.
  [[nodiscard]] std::vector<std::pair<MemberId, Vec6>> brought(const MotionMasses::Rehung& panel) const;

 private:
  [[nodiscard]] Vec6 per_kilogram(MemberId member) const;

  MotionSources from_;
  const MotionMasses& masses_;
  const StandingMotion& motion_;
};

}  // namespace topple::structure
