#pragma once
// How the velocities of a frame that moves answer impulses of the duration d: (M + d a1 K)^-1, by conjugate gradients
// on M where damping is next to nothing, else by a factor of its own.
#include <iosfwd>
#include <memory>

#include "dynamics/dynamic_state.h"

namespace topple::solver {

class FrameDynamics::State::Jumps {
 public:
  /// `softened`: d a1, s2.
  Jumps(const AnalysisOptions& options, double softened);
  ~Jumps();
  Jumps(const Jumps&) = delete;
  Jumps& operator=(const Jumps&) = delete;
  /// The matrix K + s M has another s, or another d a1.
  void set_softened(double softened);
  /// The frame's matrices are others.
  void forget_frame();

  /// Stiffness damps what an impulse sets going while it lasts: by so much of s that it has to be counted.
  [[nodiscard]] bool damps(const FrameSystem& system) const;
  /// In the scaled equations: what freedoms without mass are given comes to nothing.
  [[nodiscard]] static Eigen::VectorXd on_mass(const FrameSystem& system, Eigen::VectorXd impulses);
  /// (M + d a1 K)^-1 times impulses on mass.
  [[nodiscard]] Eigen::VectorXd velocities(const FrameSystem& system, const Eigen::VectorXd& impulses);
  /// F' (M + d a1 K)^-1 F of impulses in columns, of which those on mass alone act.
  [[nodiscard]] Eigen::MatrixXd mobility(const FrameSystem& system, const Eigen::MatrixXd& F);

  // dynamics_archive.cpp. `system`: the frame's, as it was loaded.
  void save_to(std::ostream& to) const;
  void load_from(std::istream& from, const FrameSystem& system);

 private:
  [[nodiscard]] Eigen::VectorXd velocities_by_mass(const FrameSystem& system, Eigen::VectorXd left) const;
  [[nodiscard]] FollowingFactor& factor(const FrameSystem& system);

  const AnalysisOptions& options_;
  double softened_;
  std::unique_ptr<FollowingFactor> factor_;  ///< none: not asked for yet
};

}  // namespace topple::solver
