#pragma once
// A heavy box that lies on a light one: how far the two go into each other, and how far what presses on the ground is
// from their weight.
#include <vector>

namespace topple::bench {

struct DebrisVerdict {
  double mass_ratio = 0;   ///< of the upper box to the lower
  double overlap = 0;      ///< after three seconds, over the height of a box
  double force_error = 0;  ///< of the mean force on the ground over the last second, relative
};

[[nodiscard]] std::vector<DebrisVerdict> judge_debris();

}  // namespace topple::bench
