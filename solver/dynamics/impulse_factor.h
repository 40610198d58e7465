#pragma once
// How a frame that moves takes impulses: (M + e K)^-1, by a factor of K + M/e. It is kept beside the factor of the
// substeps, follows the same changes as that does, and is made when an impulse first asks for it.
#include "dynamics/dynamic_state.h"

namespace topple::solver {

struct FrameDynamics::State::ImpulseFactor {
  /// The inertia and the frame are those of `of`. `softened`: e, s2, above 0.
  ImpulseFactor(const State& of, double softened);
  ImpulseFactor(const ImpulseFactor&) = delete;
  ImpulseFactor& operator=(const ImpulseFactor&) = delete;

  /// Takes over what has changed in the frame's matrices. Throws Instability.
  void follow(const State& of);
  /// x := (M + e K)^-1 x, in the scaled equations of the frame.
  void solve(Eigen::VectorXd& x);
  /// F' (M + e K)^-1 G in these equations; G is zero wherever F is. Only what joins their rows in the factor is gone
  /// through.
  [[nodiscard]] Eigen::MatrixXd between(const Eigen::MatrixXd& F, const Eigen::MatrixXd& G);

 private:
  [[nodiscard]] Reanalysis::State& own() { return *frame_.state_; }
  void follow_beams(const FrameSystem& now);
  void follow_plates(const FrameSystem& now);
  void follow_nodes(const FrameSystem& now);

  double softened_;
  SystemInertia inertia_;
  Reanalysis frame_;
  Eigen::VectorXd ratio_;  ///< of the scale of its equations to that of the frame's
};

}  // namespace topple::solver
