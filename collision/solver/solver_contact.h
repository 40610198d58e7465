#pragma once
#include <array>

#include "contacts/near_pairs.h"

namespace topple::collision {

/// A touching pair, and what the step did to it.
struct SolverContact {
  NearPair* pair = nullptr;
  int first = 0, second = 0;  ///< solver bodies; 0: what stands
  const Placement *first_at = nullptr, *second_at = nullptr;
  double friction = 0, restitution = 0;
  bool held = false;  ///< one of the two sleeps since it came to rest on the other, which is awake
  bool first_ball = false, second_ball = false;
  double rolling = 0;             ///< m: so far from its middle the force on a ball may act that does not roll
  int points = 0;                 ///< of the pair's manifold
  bool corners_on_second = true;  ///< they are the second's, on faces of the first
  // Where it lies in the packs.
  int pack = -1, lane = 0;
  std::array<Vec3, Manifold::most> places;  ///< of its points when the step began, global
  int told = -1;                            ///< which of the world's contacts tells of it
  // After the step.
  Vec3 impulse = Vec3::Zero();  ///< on the second, N s
  Vec3 centre = Vec3::Zero();   ///< of the normal impulses
  Vec3 moment = Vec3::Zero();   ///< on the second about the centre, N m s: about the normal
  Vec3 anchor = Vec3::Zero();   ///< where friction acts
  double lever = 0;             ///< m: mean distance of its points from there; a twist counts as a force there
  Vec3 late = Vec3::Zero();     ///< N s2: the impulse times the step, less what of that moved the bodies
  Vec3 carried = Vec3::Zero();  ///< N m s on the second, about any fixed point: it acted while the two moved on
  double load = 0;              ///< m/s2: the largest force of a point over its effective mass

  void find_places();
};

}  // namespace topple::collision
