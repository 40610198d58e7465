#include "standing/statics/displaced_rest.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace topple::structure {

namespace {
constexpr int most_iterations = 40;
/// Of the largest displacement: what is left between two iterations.
constexpr double settled = 1e-9;
/// Near the critical load the steps shrink slowly, each by the same share of the one before, the inverse of the
/// buckling factor. Where that share is as steady as this, their sum is known.
constexpr double steady = 0.02, slow = 0.2, critical = 0.9999;
/// Of the first displacements: what has gone so far never settles. Forces and displacements grow by each other, so that
/// a few iterations more end in numbers that are none.
constexpr double lost = 1e6;

double largest(const std::vector<Vec6>& displacements) {
  double size = 0;
  for (const Vec6& one : displacements) size = std::max(size, one.cwiseAbs().maxCoeff());
  return size;
}

/// Share of the step before that a step is, over all nodes.
double shrinkage(const std::vector<Vec6>& step, const std::vector<Vec6>& before) {
  double both = 0, square = 0;
  for (std::size_t n = 0; n < step.size(); ++n) {
    both += step[n].dot(before[n]);
    square += before[n].squaredNorm();
  }
  return square > 0 ? both / square : 0;
}
}  // namespace

DisplacedRest find_displaced_rest(std::vector<Vec6> first, const DisplacedAnswer& answer) {
  std::vector<Vec6> before = std::move(first);
  std::vector<Vec6> step(before.size(), Vec6::Zero()), step_before = step;
  double last = 0, share = 0, at_first = largest(before);
  int since = 0;  // steps since one was made longer
  for (int k = 0; k < most_iterations; ++k) {
    const std::vector<Vec6>* const answered = answer(before);
    if (answered == nullptr) return DisplacedRest::mechanism;
    const std::vector<Vec6>& now = *answered;
    double moved = 0;
    for (std::size_t n = 0; n < now.size(); ++n) moved = std::max(moved, (now[n] - before[n]).cwiseAbs().maxCoeff());
    const double size = largest(now);
    if (k == 0) at_first = std::max(at_first, size);
    if (moved <= settled * size) return DisplacedRest::found;
    if ((since > 3 && moved > last) || !(size <= lost * at_first)) break;
    last = moved;
    std::swap(step, step_before);
    for (std::size_t n = 0; n < now.size(); ++n) step[n] = now[n] - before[n];
    before = now;
    ++since;
    const double share_before = std::exchange(share, shrinkage(step, step_before));
    if (since < 3 || share < slow || share > critical || std::abs(share - share_before) > steady) continue;
    for (std::size_t n = 0; n < before.size(); ++n) before[n] += share / (1 - share) * step[n];
    since = 0;
  }
  return DisplacedRest::none;
}

}  // namespace topple::structure
