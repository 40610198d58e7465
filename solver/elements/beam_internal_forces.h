#pragma once
// Internal forces of a straight beam under its end force and loads, exactly: polynomials between the places where a
// load begins, ends or acts.
#include <array>
#include <span>
#include <vector>

#include "topple/solver/frame_model.h"

namespace topple::solver {

/// Stretch of a beam on which every internal force is one polynomial. Coefficients are in powers of the distance from
/// `start`.
struct BeamPiece {
  double start = 0, length = 0;
  /// axial, shear_y, shear_z, torsion, moment_y, moment_z: what the part beyond does to the part before.
  std::array<std::array<double, 4>, 6> force{};
};

/// How a piece deforms, in powers of the distance from its start: the deformation of a beam whose first end stays where
/// it is (u, v, w, and the rotations of the section).
struct DeformedPiece {
  std::array<double, 6> v{}, w{};
  std::array<double, 5> theta_x{}, theta_y{}, theta_z{}, u{};
};

struct InternalForces {
  std::vector<BeamPiece> pieces;
  /// Beyond the last load: what must act on the second end for equilibrium.
  Vec6 second_end = Vec6::Zero();
  /// Free strain and free curvatures (rotation per length about y and z) from temperature.
  double free_strain = 0, free_curvature_y = 0, free_curvature_z = 0;
  std::vector<double> places;  ///< where pieces begin and the last one ends
};

/// `first_end` is what acts on the first end, local axes. Loads outside of the beam are an std::invalid_argument.
[[nodiscard]] InternalForces internal_forces(double length, const Vec6& first_end, std::span<const BeamLoad> loads);
/// The same in the storage of an earlier result.
void find_internal_forces(double length, const Vec6& first_end, std::span<const BeamLoad> loads,
                          InternalForces& result);

/// Integrates u' = N/EA + strain, rx' = T/GJ, ry' = My/EIy + curvature, rz' = Mz/EIz + curvature, v' = rz + Vy/GAy,
/// w' = -ry + Vz/GAz from zero at the first end. Returns the displacement of the second end; appends the pieces when
/// asked. `factor` multiplies E and G.
[[nodiscard]] Vec6 integrate_deformation(const Beam& beam, double factor, const InternalForces& forces,
                                         std::vector<DeformedPiece>* pieces = nullptr);

/// Compliance for a stiffness, where a stiffness of zero stands for one that is not looked at (no shear deformation).
[[nodiscard]] inline double inverse_or_zero(double stiffness) { return stiffness > 0 ? 1 / stiffness : 0; }

/// Value of a polynomial at t.
template <std::size_t N>
[[nodiscard]] double polynomial(const std::array<double, N>& coefficient, double t) {
  double value = coefficient[N - 1];
  for (std::size_t k = N - 1; k-- > 0;) value = value * t + coefficient[k];
  return value;
}

}  // namespace topple::solver
