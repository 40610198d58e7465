#pragma once
// (M + e K)^-1 of a frame that moves, by a factor of K + M/e: how it takes impulses, and substeps that are shorter than
// its own. It is kept beside the factor of the substeps, follows the same changes as that does, and is made when it is
// first asked for.
#include <iosfwd>

#include "dynamics/dynamic_state.h"

namespace topple::solver {

struct FrameDynamics::State::FollowingFactor {
  /// Of a frame that moves, with its inertia. `softened`: e, s2, above 0.
  FollowingFactor(const FrameSystem& frame, const AnalysisOptions& options, double softened);
  FollowingFactor(const FollowingFactor&) = delete;
  FollowingFactor& operator=(const FollowingFactor&) = delete;

  /// The frame's matrices are others.
  void forget_frame() { followed_ = false; }
  /// Takes over what has changed in them; false: nothing has. Throws Instability.
  bool follow(const FrameSystem& now);
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
  bool followed_ = false;  ///< it has the frame's matrices as they are
};

}  // namespace topple::solver
