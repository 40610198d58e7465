#include "dynamics/settling_load.h"

#include <utility>

namespace topple::solver {
namespace {

/// Of the load: what it may still change from one pass to the next.
constexpr double settled_change = 1e-9;

}  // namespace

void SettlingLoad::begin(Eigen::VectorXd at_start) {
  start_ = std::move(at_start);
  end_ = start_;
}

SettlingLoad::Pass SettlingLoad::iterate(Eigen::VectorXd at_end) {
  if (!at_end.allFinite()) return Pass::lost;
  const double change = (at_end - end_).lpNorm<Eigen::Infinity>();
  const double size = at_end.lpNorm<Eigen::Infinity>();
  if (change <= settled_change * size) return Pass::settled;
  end_ = std::move(at_end);
  return Pass::open;
}

}  // namespace topple::solver
