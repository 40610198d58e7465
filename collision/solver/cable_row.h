#pragma once
// A cable from a point in space to a body's centre, as one row.
//
// Velocities are those of the middle of the sub-step, so the pull along the cable's direction at its beginning, of the
// size that puts the centre on the sphere at its end, is the SHAKE scheme (Ryckaert, Ciccotti and Berendsen, J. Comput.
// Phys. 23, 1977): second order, symplectic, and the length is met to rounding, with nothing that drifts.
#include "solver/equilibrium.h"
#include "solver/solver_body.h"

namespace topple::collision {

struct CableRow {
  Vec3 anchor = Vec3::Zero();
  double length = 0;
  int body = 0;                 ///< of the step's solver
  Vec3 impulse = Vec3::Zero();  ///< on the body over the step, N s
  double pulled = 0;            ///< the sum of their sizes, N s

  /// Takes out what would carry the body beyond the cable's end in this sub-step. `changed` gets what it did.
  void hold(const SolverBody& of, double h, const Motion6& displacement, Motion6& velocity, Motion6& changed);
  /// As an equilibrium takes it: of the tension of the last step, which was `dt` long.
  [[nodiscard]] RestJoint at_rest(const SolverBody& of, double dt) const;
  void store_rest(double tension, double dt);

  /// Between steps.
  template <class Archive>
  void serialize(Archive& archive) {
    auto& [from, reach, number, total, sum, away] = *this;
    archive(from, reach, away);  // a step sets the others before it reads them
  }

 private:
  Vec3 direction_ = Vec3::Zero();  ///< away from the anchor
};

}  // namespace topple::collision
