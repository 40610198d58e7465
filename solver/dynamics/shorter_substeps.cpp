#include "dynamics/shorter_substeps.h"

#include "dynamics/following_factor.h"

namespace topple::solver {

FrameDynamics::State::ShorterSubsteps::ShorterSubsteps(const AnalysisOptions& options) : options_(options) {}
FrameDynamics::State::ShorterSubsteps::~ShorterSubsteps() = default;

void FrameDynamics::State::ShorterSubsteps::forget_frame() {
  for (auto& [parts, one] : factors_) one.factor->forget_frame();
}

void FrameDynamics::State::ShorterSubsteps::solve(const FrameSystem& system, int parts, double s, Eigen::VectorXd& x) {
  One& one = factors_[parts];
  if (!one.factor) {
    one.factor = std::make_unique<FollowingFactor>(system, options_, 1 / s);
    one.s = s;
  }
  if (one.factor->follow(system)) one.factor->renew();
  one.factor->solve(x);
  x /= s;
}

}  // namespace topple::solver
