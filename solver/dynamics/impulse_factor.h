#pragma once
// How a frame that moves takes impulses: (M + e K)^-1, by a factor of K + M/e. It is kept beside the factor of the
// substeps, follows the same changes as that does, and is made when an impulse first asks for it.
#include <iosfwd>

#include "dynamics/dynamic_state.h"

namespace topple::solver {

struct FrameDynamics::State::ImpulseFactor {
  /// Of a frame that moves, with its inertia. `softened`: e, s2, above 0.
  ImpulseFactor(const FrameSystem& frame, const AnalysisOptions& options, double softened);
  ImpulseFactor(const ImpulseFactor&) = delete;
  ImpulseFactor& operator=(const ImpulseFactor&) = delete;

  /// Takes over what has changed in the frame's matrices. Throws Instability.
  void follow(const FrameSystem& now);
  /// To be called before solves of a structure that does not change: Reanalysis::State::renew_factor(). Throws
  /// Instability.
  void renew();
  /// x := (M + e K)^-1 x, in the scaled equations of the frame.
  void solve(Eigen::VectorXd& x);
  /// F' (M + e K)^-1 G in these equations; G is zero wherever F is. Only what joins their rows in the factor is gone
  /// through.
  [[nodiscard]] Eigen::MatrixXd between(const Eigen::MatrixXd& F, const Eigen::MatrixXd& G);

  // dynamics_archive.cpp. Of one with the same damping.
  void save_to(std::ostream& to) const;
  void load_from(std::istream& from);

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
