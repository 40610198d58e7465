#include "elements/beam_energy.h"

#include <cmath>

#include "elements/beam_end_springs.h"
#include "elements/beam_internal_forces.h"

namespace topple::solver {
namespace {

/// Integral of the square of a cubic over 0 ... length: Gauss with four points is exact to degree seven.
double integral_of_square(const std::array<double, 4>& p, double length) {
  static const double inner = std::sqrt(3.0 / 7 - 2.0 / 7 * std::sqrt(6.0 / 5));
  static const double outer = std::sqrt(3.0 / 7 + 2.0 / 7 * std::sqrt(6.0 / 5));
  static const double inner_weight = (18 + std::sqrt(30.0)) / 36, outer_weight = (18 - std::sqrt(30.0)) / 36;
  double sum = 0;
  for (const auto& [place, weight] : {std::pair(-outer, outer_weight), std::pair(-inner, inner_weight),
                                      std::pair(inner, inner_weight), std::pair(outer, outer_weight)}) {
    const double value = polynomial(p, length / 2 * (1 + place));
    sum += weight * value * value;
  }
  return sum * length / 2;
}

}  // namespace

double beam_strain_energy(const Beam& beam, double factor, const Vec12& end_forces, std::span<const BeamLoad> loads) {
  const double E = factor * beam.youngs_modulus, G = factor * beam.shear_modulus;
  const std::array<double, 6> stiffness{E * beam.area, G * beam.shear_area_y, G * beam.shear_area_z,
                                        G * beam.J,    E * beam.Iy,           E * beam.Iz};
  double energy = 0;
  const InternalForces forces = internal_forces(beam.length, end_forces.head<6>(), loads);
  for (const BeamPiece& piece : forces.pieces) {
    for (std::size_t k = 0; k < 6; ++k) {
      if (stiffness[k] > 0) energy += integral_of_square(piece.force[k], piece.length) / (2 * stiffness[k]);
    }
  }
  for (int f = 0; f < 12; ++f) {
    const double compliance = spring_compliance(beam.end_stiffness[static_cast<std::size_t>(f / 6)](f % 6));
    if (std::isfinite(compliance)) energy += compliance * end_forces(f) * end_forces(f) / 2;
  }
  return energy;
}

}  // namespace topple::solver
