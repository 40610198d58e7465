#pragma once
// Waking of sleeping bodies: an awake body reaches them, or the force that presses on them changes.
#include <span>

#include "debris/pair_search.h"

namespace topple::collision {

/// Wakes bodies of the scene.
class Waking {
 public:
  Waking(DebrisScene& scene, PairSearch& search) : scene_(scene), search_(search) {}

  /// What an awake body comes upon within `dt`, before the step is solved: as a free body it takes the impact. What
  /// that brings together is sought.
  void wake_struck(double dt);
  /// What a pair did in the last part of a step.
  struct Push {
    NearPair* pair;
    Vec3 impulse;  ///< on the second, N s
  };
  /// Where what presses on what sleeps has changed.
  void wake_changed(std::span<const Push> pushes, double dt);

 private:
  void wake_round(DebrisBody& struck, double momentum);

  DebrisScene& scene_;
  PairSearch& search_;
};

}  // namespace topple::collision
