#pragma once
// Momentum that a frame's velocities leave out when it changes within a substep: a joint's force acts until it breaks,
// a beam that swings from one end alone leaves its nodes behind, mass brings its own along. The force is a load over
// that substep; the rest are impulses at its start.
#include <map>
#include <optional>
#include <vector>

#include "assembly/element_masses.h"
#include "assembly/frame_system.h"
#include "dynamics/motion_state.h"
#include "reanalysis/requested_changes.h"

namespace topple::solver {

class ChangedMomentum {
 public:
  /// Loads of the last substep's breaks end.
  void begin_substep();
  /// Before the frame changes: how the ends of beams that will change follow their nodes in this motion (scaled
  /// equations), where that has them, and the beams' momentum.
  void remember(const FrameSystem& system, const SystemInertia& inertia, const RequestedChanges& changes,
                const MotionState& motion);
  /// The next part of a substep begins, of the length h; as many are left. What has left by now goes on with its loads.
  void begin_part(const FrameSystem& system, const RequestedChanges& changes, double h, int left);
  /// The joint broke; until then its force acted: its mean over the substep, local.
  void break_joint(int beam, std::size_t end, const Vec6& mean_force);
  /// FrameDynamics::add_momentum().
  void bring(int beam, const Vec6& momentum);
  [[nodiscard]] bool any_brought() const { return !brought_.empty(); }

  // Per equation, then per held freedom; not scaled.
  /// Forces over the substep.
  [[nodiscard]] Eigen::VectorXd load(const FrameSystem& system);
  /// Impulses: the momentum that these velocities leave out, beside what left.
  [[nodiscard]] Eigen::VectorXd impulses(const FrameSystem& system, const SystemInertia& inertia,
                                         const Eigen::VectorXd& velocities) const;
  /// The velocities have them all now.
  void forget_impulses(const FrameSystem& system);
  /// Of a beam that bears the force of its broken end in that load: fixed-end forces, local.
  [[nodiscard]] Vec12 fixed_end(int beam) const;
  [[nodiscard]] Vec6 brought_to(int beam) const;
  /// What a beam that changed in this substep left with, if it did: its momentum before, less what its joints' forces
  /// took, and with what its loads gave.
  struct Left {
    Vec6 momentum = Vec6::Zero();
    Vec12 ends = Vec12::Zero();  ///< displacements of its own ends, local, as they went on
    template <class Archive>
    void serialize(Archive& archive) {
      archive(momentum, ends);
    }
  };
  [[nodiscard]] std::optional<Left> left_with(const FrameSystem& system, int beam, const std::vector<BeamLoad>& loads,
                                              double h) const;

  template <class Archive>
  void serialize(Archive& archive) {
    auto& [broken, changed, brought, fixed_end, left] = *this;
    archive(broken, changed, brought, fixed_end, left);
  }

 private:
  struct BrokenJoint {
    int beam;
    std::size_t end;
    Vec6 mean_force;
    template <class Archive>
    void serialize(Archive& archive) {
      auto& [of_beam, at_end, until_then] = *this;
      archive(of_beam, at_end, until_then);
    }
  };
  struct ChangedBeam {
    int beam;
    Mat12 followed;
    Vec6 momentum;
    Vec12 ends, end_rates;  ///< of its own ends, local
    template <class Archive>
    void serialize(Archive& archive) {
      auto& [number, follows, at_start, displacements, velocities] = *this;
      archive(number, follows, at_start, displacements, velocities);
    }
  };
  /// Of the part of a substep that ended.
  void forget_part();
  void add_brought(const FrameSystem& system, Eigen::VectorXd& impulse) const;

  std::vector<BrokenJoint> broken_;
  std::vector<ChangedBeam> changed_;
  std::map<int, Vec6> brought_;     ///< per beam
  std::map<int, Vec12> fixed_end_;  ///< of beams that bear the force of their broken end in this substep, local
  std::map<int, Left> left_;        ///< beams that left in an earlier part of the substep, at its end
};

}  // namespace topple::solver
