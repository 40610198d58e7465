#pragma once
// Frames that grow harder to solve along one parameter each.
#include <string>
#include <vector>

#include "topple/solver/frame_model.h"

namespace topple::bench {

struct Case {
  std::string family, what;  ///< what: the variant within the family
  double parameter = 0;
  solver::FrameModel model;
  solver::LoadSet loads;
  bool mechanism = false;  ///< it cannot stand: the only right answer is that
};

/// Parts of a regular frame stiffer or softer than the rest, by 1 to 1e14.
[[nodiscard]] std::vector<Case> stiffness_ratios();
/// A portal of square bars, length over side from 2 to 1e7.
[[nodiscard]] std::vector<Case> slendernesses();
/// Chains of 10 to `most` members: a cantilever, one that is held at every tenth node, a ladder of two chains.
[[nodiscard]] std::vector<Case> chains(int most);
/// One frame in units from nanometres to megametres and from micronewtons to giganewtons.
[[nodiscard]] std::vector<Case> unit_systems();
/// Structures that less and less keeps from moving, down to nothing.
[[nodiscard]] std::vector<Case> near_mechanisms();
/// Small frames of members in any direction, springs among their joints, lengths and sections over some decades, all by
/// chance: where the bound is as tight as it gets, and where nobody thought of.
/// The same seed gives the same frame.
[[nodiscard]] Case chance_frame(unsigned seed);

}  // namespace topple::bench
