#pragma once
// A heavy box that lies on a light one: how far the heavy one comes down, whether the watch for overlaps says so, and
// how far what presses on the ground is from their weight.
#include <vector>

namespace topple::bench {

struct DebrisVerdict {
  double side = 0;         ///< of both boxes, m
  double mass_ratio = 0;   ///< of the upper box to the lower
  double error = 0;        ///< how far the upper box is from where it began after ten seconds, over its height
  double bound = 0;        ///< what follows from the deepest lasting overlap that is told, over its height
  bool warned = false;     ///< an overlap was told as deep
  double force_error = 0;  ///< of the mean force on the ground over the last second, relative
  /// Wrong by more than what is told, without a warning.
  [[nodiscard]] bool false_confidence() const { return !warned && !(error <= bound); }
};

[[nodiscard]] std::vector<DebrisVerdict> judge_debris();

}  // namespace topple::bench
