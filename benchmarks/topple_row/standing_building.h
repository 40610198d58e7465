#pragma once
// A building under its first combination as the solver sees it, and how far an answer is from the reference: the
// measures of the baseline (sag of the roof, split of reactions, joint forces).
#include <vector>

#include "extended_frame.h"
#include "topple/solver/reanalysis.h"
#include "topple/structure/building.h"
#include "topple/structure/frame.h"

namespace topple::bench {

using Exact = reference::Answer<reference::Extended>;

struct StandingBuilding {
  structure::Building building;
  structure::Frame frame;
  solver::LoadSet loads;
  std::vector<int> roof;  ///< nodes at the greatest height

  /// `frame_only`: without what acts on panels.
  StandingBuilding(structure::Building given, bool frame_only);
};

struct Errors {
  double sag = 0, sag_error = 0, reaction_sum = 0, least_share = 1e300, largest_share = -1e300;
  double reactions = 0, posts = 0, shears = 0, moments = 0;
};

/// Relative: of the mean roof sag, and root mean square over all joints of a kind.
[[nodiscard]] Errors measure(const StandingBuilding& standing, const solver::StaticSolution& answer,
                             const Exact& exact);
/// As a JSON object on standard output.
void print(const Errors& errors);

/// The present answer of a reanalysis, whole.
[[nodiscard]] solver::StaticSolution state_of(const solver::Reanalysis& standing);
/// Gives a reanalysis its loads, which it keeps for each beam and node.
void apply(solver::Reanalysis& standing, const solver::LoadSet& loads);

}  // namespace topple::bench
