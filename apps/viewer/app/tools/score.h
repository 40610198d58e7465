#pragma once
// How well a building was brought down.
#include "renderer/snapshot.h"
#include "topple/structure/building.h"

namespace topple::viewer {

/// The goal: all of it down, on its own ground, with one action.
struct Score {
  double down = 0;    ///< share of the building's mass that stands no more
  double inside = 1;  ///< share of the mass of bodies that lies within the footprint and `score_margin` around it
  int actions = 0;    ///< what was done to it
  /// 100 down inside, less a tenth of that for each action after the first; never below 0.
  [[nodiscard]] int points() const;
};
inline constexpr double score_margin = 3;  ///< m
inline constexpr double goal_share = 0.9;  ///< of the mass: a goal is reached

/// Masses are those of members and panels (density times volume), of broken ones by what is left of their meshes. The
/// footprint is the box around all nodes, in global x and y.
[[nodiscard]] Score score_of(const structure::Building& building, const Snapshot& moment, int actions);

}  // namespace topple::viewer
