#pragma once
// Factors for substeps that are parts of a frame's own: each is made when a substep is first divided so, and kept.
#include <iosfwd>
#include <map>
#include <memory>

#include "dynamics/following_factor.h"

namespace topple::solver {

class FrameDynamics::State::ShorterSubsteps {
 public:
  explicit ShorterSubsteps(const AnalysisOptions& options);
  ~ShorterSubsteps();
  ShorterSubsteps(const ShorterSubsteps&) = delete;
  ShorterSubsteps& operator=(const ShorterSubsteps&) = delete;

  /// The frame's matrices are others.
  void forget_frame();
  /// Its method is.
  void clear() { factors_.clear(); }
  /// x := (K + s M)^-1 x in the scaled equations of the frame, s of a substep that is one of so many parts.
  void solve(const FrameSystem& system, int parts, double s, Eigen::VectorXd& x);

  // dynamics_archive.cpp. `system`: the frame's, as it was loaded.
  void save_to(std::ostream& to) const;
  void load_from(std::istream& from, const FrameSystem& system);

 private:
  struct One {
    std::unique_ptr<FollowingFactor> factor;
    double s = 0;  ///< 1/s2
  };
  const AnalysisOptions& options_;
  std::map<int, One> factors_;  ///< by parts
};

}  // namespace topple::solver
