#pragma once
// A beam's end forces from what strains it, for those who ask again and again: of its stiffness only the entries that
// are not zero.
#include <array>

#include "elements/beam.h"

namespace topple::solver {

class BeamStrainForces {
 public:
  BeamStrainForces() = default;
  explicit BeamStrainForces(const CondensedBeam& beam);
  /// End forces (local axes) of a strain as relative_motion() has it: strain_stiffness() times it, to the last bit.
  [[nodiscard]] Vec12 operator()(const Vec6& strain) const {
    Vec12 force;
    force(0) = axial_[0] * strain(0);
    force(6) = axial_[1] * strain(0);
    force(3) = torsion_[0] * strain(3);
    force(9) = torsion_[1] * strain(3);
    for (std::size_t k = 0; k < 4; ++k) {
      force(in_xy[k]) = xy_[k][0] * strain(1) + xy_[k][1] * strain(5);
      force(in_xz[k]) = xz_[k][0] * strain(2) + xz_[k][1] * strain(4);
    }
    return force;
  }
  /// Twice the strain energy.
  [[nodiscard]] double twice_energy(const Vec6& strain) const { return strain.dot(Vec6((*this)(strain).tail<6>())); }

 private:
  static constexpr std::array<int, 4> in_xy{1, 5, 7, 11}, in_xz{2, 4, 8, 10};
  std::array<double, 2> axial_{}, torsion_{};
  std::array<std::array<double, 2>, 4> xy_{}, xz_{};
};

}  // namespace topple::solver
