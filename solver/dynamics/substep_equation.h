#pragma once
// The equation of one substep, (K + s M) w = f + M (s q - am a), and the motion that its solution makes: see
// generalized_alpha.h.
#include "assembly/frame_system.h"
#include "dynamics/generalized_alpha.h"
#include "dynamics/motion_state.h"
#include "dynamics/products.h"
#include "topple/solver/frame_dynamics.h"

namespace topple::solver {

class SubstepEquation {
 public:
  /// From the motion at the start and the load, both scaled. `products`: of that motion, as EnergyLedger has them,
  /// where they are known; else null.
  void set(const FrameSystem& system, const GeneralizedAlpha& method, const RayleighDamping& damping,
           const MotionState& start, const Eigen::VectorXd& load, const SideBySide<8>* products);
  /// The right-hand side, to be solved in place.
  [[nodiscard]] Eigen::VectorXd& w() { return w_; }
  /// From w: the motion at the substep's end.
  void find_end(const GeneralizedAlpha& method, const MotionState& start, MotionState& end) const;

 private:
  Eigen::VectorXd q_, w_;
  SideBySide<1> z_, mass_z_;
};

}  // namespace topple::solver
