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
  /// Its mass moved with what bore it. Once it leaves, that mass lies where the panel is, and turns with its spin():
  /// the linear momentum is kept.
  [[nodiscard]] Vec6 of(PanelId panel) const;
  [[nodiscard]] Vec6 of(NodeId node) const;  ///< of what lies on it
  /// m/s, of the panel's mass, in the mean.
  [[nodiscard]] Vec3 velocity(PanelId panel) const;
  /// rad/s: of the rigid motion with the momentum that its mass has on what bears it. Its corners are light, and swing
  /// back when something breaks; they tell of axes alone on which all of its mass lies, and of shells, which have their
  /// mass there.
  [[nodiscard]] Vec3 spin(PanelId panel) const;
  /// N s: what members give up as less of a panel lies on them, what it brings other members apart.
  [[nodiscard]] Vec3 given_up(const MotionMasses::Rehung& panel) const;
  /// Momentum of a panel for those that bear it now, or bore it until now where nothing of it is left: by their masses
  /// of it.
  [[nodiscard]] std::vector<std::pair<MemberId, Vec6>> shared(const MotionMasses::Rehung& panel,
                                                              const Vec3& momentum) const;
  /// What a panel that lies on other members now brings them beyond their own velocity. Its mass has the mean velocity
  /// of what bore it, and shares it inelastically with what bears it now: linear and angular momentum are kept.
  [[nodiscard]] std::vector<std::pair<MemberId, Vec6>> brought(const MotionMasses::Rehung& panel) const;

 private:
  using Shares = std::vector<std::pair<MemberId, double>>;
  [[nodiscard]] bool includes(MemberId member) const;
  [[nodiscard]] Vec3 middle(MemberId member) const;
  [[nodiscard]] Vec6 per_kilogram(MemberId member) const;
  /// rad/s, as its corners turn about each other; 0 where fewer than three tell.
  [[nodiscard]] Vec3 spin_of_corners(PanelId panel) const;

  MotionSources from_;
  const MotionMasses& masses_;
  const StandingMotion& motion_;
};

}  // namespace topple::structure
