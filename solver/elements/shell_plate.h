#pragma once
// Plate bending with transverse shear: MITC4 (Bathe and Dvorkin 1985). Deflection and rotations bilinear, the covariant
// shear strains taken from the middles of the edges, so that nothing locks however thin the plate.
#include "elements/shell_membrane.h"

namespace topple::solver {

/// Per node w, rotation about x, rotation about y.
using PlateMatrix = Eigen::Matrix<double, 12, 12>;
using PlateVector = Eigen::Matrix<double, 12, 1>;

class ShellPlate {
 public:
  ShellPlate(const Quadrilateral& corners, double youngs_modulus, double poisson_ratio, double thickness);

  [[nodiscard]] PlateMatrix stiffness() const;
  /// Moments per length mx, my, mxy (the integrals of stress times z) and shears qx, qy at xi, eta.
  [[nodiscard]] Eigen::Matrix<double, 5, 1> forces(const PlateVector& displacements, double xi, double eta) const;

 private:
  /// Curvatures, then shear strains, per unit freedom.
  [[nodiscard]] Eigen::Matrix<double, 3, 12> curvatures(double xi, double eta) const;
  [[nodiscard]] Eigen::Matrix<double, 2, 12> shears(double xi, double eta) const;
  [[nodiscard]] Eigen::Matrix<double, 1, 12> covariant_shear(double xi, double eta, int direction) const;

  Quadrilateral corners_;
  Eigen::Matrix3d bending_;
  double shear_;                                            ///< 5/6 G t
  std::array<Eigen::Matrix<double, 1, 12>, 4> edge_shear_;  ///< along xi at eta = -1, 1; along eta at xi = -1, 1
};

}  // namespace topple::solver
