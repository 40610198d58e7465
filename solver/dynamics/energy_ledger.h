#pragma once
// Energies since the start, and what their terms in a substep are found with: products of the matrices with the motion.
#include "assembly/frame_system.h"
#include "dynamics/generalized_alpha.h"
#include "dynamics/motion_state.h"
#include "dynamics/products.h"
#include "topple/solver/frame_dynamics.h"

namespace topple::solver {

class EnergyLedger {
 public:
  /// For energies outside of a substep, or in hinges.
  [[nodiscard]] DynamicEnergy& terms() { return energy_; }
  [[nodiscard]] const DynamicEnergy& terms() const { return energy_; }

  /// The motion or the matrices are others.
  void forget_products() { known_ = false; }
  /// Of a motion, by rows: M u, M v, M a, 0, (K + s M) u, (K + s M) v, 0, 0.
  [[nodiscard]] const SideBySide<8>& products(const FrameSystem& system, const MotionState& motion);
  /// What is stored in a motion: 1/2 v'Mv + 1/2 u'Ku + `of_kinks`.
  double store(const FrameSystem& system, const MotionState& motion, double of_kinks);

  // A substep that is to be accepted, from its start on.
  /// What the loads do along the way; what those of breaks do is freed.
  void book_loads(const MotionState& start, const MotionState& end, const Eigen::VectorXd& load,
                  const Eigen::VectorXd& of_breaks);
  /// What damping takes by the motion at the start.
  void book_start(const GeneralizedAlpha& method, const RayleighDamping& damping);
  /// And by that at the end, once it is stored; what the method itself takes.
  void book_end(const MotionState& start, const MotionState& end, const GeneralizedAlpha& method,
                const RayleighDamping& damping);

  template <class Archive>
  void serialize(Archive& archive) {
    // Products with the motion are found again with the same bits; all that follows them is of one substep alone.
    auto& [energy, products, known, s, old_products, moved, motion] = *this;
    if constexpr (Archive::is_loading::value) known = false;
    archive(energy);
  }

 private:
  void find_products(const FrameSystem& system, const MotionState& motion);
  void book_numerical(const MotionState& start, const MotionState& end, const GeneralizedAlpha& method);

  DynamicEnergy energy_;
  SideBySide<8> products_;
  bool known_ = false;
  double s_ = 0;                ///< of these products
  SideBySide<2> old_products_;  ///< M a and K u at the start of the substep that was accounted last
  Eigen::VectorXd moved_;       ///< in it
  SideBySide<8> motion_;        ///< scratch
};

}  // namespace topple::solver
