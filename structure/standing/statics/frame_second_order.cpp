// Second order in a collapse that runs: the elastic factor serves, the geometric forces come in as loads.
#include <algorithm>

#include <cmath>
#include <utility>

#include "standing/statics/frame_statics.h"
#include "topple/solver/geometric_forces.h"

namespace topple::structure {

namespace {
constexpr int most_iterations = 40;
/// Of the largest displacement: what is left between two iterations.
constexpr double settled = 1e-9;
/// Near the critical load the steps shrink slowly, each by the same share of the one before, the inverse of the
/// buckling factor. Where that share is as steady as this, their sum is known.
constexpr double steady = 0.02, slow = 0.2, critical = 0.9999;

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

/// Iterates u' = K^-1 (F - Kg(N) u) from the answer of the loads with the geometric forces of the last answer. The end
/// forces then hold the displaced member in balance. What the slowest share leaves is added at once (Aitken; Irons and
/// Tuck 1969, International Journal for Numerical Methods in Engineering 1). False when it does not settle: the
/// first-order answer is back.
bool FrameStatics::displace(int number) {
  Component& component = components_[static_cast<std::size_t>(number)];
  const auto geometric = [](const solver::Beam& own, const solver::Vec12& force, const std::vector<Vec6>& at) {
    return solver::geometric_forces(own, force, at[static_cast<std::size_t>(own.node[0])],
                                    at[static_cast<std::size_t>(own.node[1])]);
  };
  std::vector<Vec6> before = component.analysis->displacements();
  std::vector<Vec6> step(before.size(), Vec6::Zero()), step_before = step;
  double last = 0, share = 0;
  int since = 0;  // steps since one was made longer
  for (int k = 0; k < most_iterations; ++k) {
    std::vector<Vec6> push(nodes(number).size(), Vec6::Zero());
    for (MemberId member : members(number)) {
      const solver::Vec12& force = end_forces_[index(member)];
      if (force.isZero(0)) continue;
      const solver::Beam& own = beam(member);
      const solver::Vec12 at = solver::node_forces(own, geometric(own, force, before));
      for (std::size_t end = 0; end < 2; ++end)
        push[static_cast<std::size_t>(own.node[end])] -= at.segment<6>(static_cast<Eigen::Index>(6 * end));
    }
    for (std::size_t n = 0; n < push.size(); ++n) {
      geometric_[index(nodes(number)[n])] = push[n];
      write_load(nodes(number)[n]);
    }
    if (!component.analysis->solve().stable) return true;  // as stable as it was without these loads
    read_end_forces(number);
    const std::vector<Vec6>& now = component.analysis->displacements();
    double moved = 0, size = 0;
    for (std::size_t n = 0; n < now.size(); ++n) {
      moved = std::max(moved, (now[n] - before[n]).cwiseAbs().maxCoeff());
      size = std::max(size, now[n].cwiseAbs().maxCoeff());
    }
    if (moved <= settled * size) {
      for (MemberId member : members(number)) {
        const solver::Beam& own = beam(member);
        solver::Vec12& force = end_forces_[index(member)];
        if (force.isZero(0)) continue;
        force += geometric(own, force, now);
      }
      return true;
    }
    if (since > 3 && moved > last) break;
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
  for (NodeId node : nodes(number)) {
    geometric_[index(node)].setZero();
    write_load(node);
  }
  (void)component.analysis->solve();
  read_end_forces(number);
  return false;
}

}  // namespace topple::structure
