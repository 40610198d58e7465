#include "elements/shell_plate.h"

#include <Eigen/LU>

namespace topple::solver {

ShellPlate::ShellPlate(const Quadrilateral& corners, double youngs_modulus, double poisson_ratio, double thickness)
    : corners_(corners) {
  constexpr double shear_correction = 5.0 / 6;  // parabolic shear stress over the thickness (Reissner)
  const double nu = poisson_ratio, t = thickness;
  bending_ << 1, nu, 0, nu, 1, 0, 0, 0, (1 - nu) / 2;
  bending_ *= youngs_modulus * t * t * t / (12 * (1 - nu * nu));
  shear_ = shear_correction * youngs_modulus / (2 * (1 + nu)) * t;
  edge_shear_ = {covariant_shear(0, -1, 0), covariant_shear(0, 1, 0), covariant_shear(-1, 0, 1),
                 covariant_shear(1, 0, 1)};
}

Eigen::Matrix<double, 1, 12> ShellPlate::covariant_shear(double xi, double eta, int direction) const {
  const Bilinear shape(xi, eta);
  const Eigen::RowVector2d tangent = shape.jacobian(corners_).row(direction);
  const Eigen::Vector4d& slope = direction == 0 ? shape.dxi : shape.deta;
  Eigen::Matrix<double, 1, 12> B;
  for (int n = 0; n < 4; ++n) {
    B(3 * n) = slope(n);
    B(3 * n + 1) = -shape.N(n) * tangent.y();
    B(3 * n + 2) = shape.N(n) * tangent.x();
  }
  return B;
}

Eigen::Matrix<double, 2, 12> ShellPlate::shears(double xi, double eta) const {
  Eigen::Matrix<double, 2, 12> covariant;
  covariant.row(0) = ((1 - eta) * edge_shear_[0] + (1 + eta) * edge_shear_[1]) / 2;
  covariant.row(1) = ((1 - xi) * edge_shear_[2] + (1 + xi) * edge_shear_[3]) / 2;
  return Bilinear(xi, eta).jacobian(corners_).inverse() * covariant;
}

Eigen::Matrix<double, 3, 12> ShellPlate::curvatures(double xi, double eta) const {
  const Bilinear shape(xi, eta);
  const Eigen::Matrix2d inverse = shape.jacobian(corners_).inverse();
  Eigen::Matrix<double, 3, 12> B = Eigen::Matrix<double, 3, 12>::Zero();
  for (int n = 0; n < 4; ++n) {
    const Vec2 gradient = inverse * Vec2(shape.dxi(n), shape.deta(n));
    B(0, 3 * n + 2) = gradient.x();
    B(1, 3 * n + 1) = -gradient.y();
    B(2, 3 * n + 1) = -gradient.x();
    B(2, 3 * n + 2) = gradient.y();
  }
  return B;
}

PlateMatrix ShellPlate::stiffness() const {
  PlateMatrix K = PlateMatrix::Zero();
  for (double xi : gauss2) {
    for (double eta : gauss2) {
      const double dA = Bilinear(xi, eta).jacobian(corners_).determinant();
      const auto B = curvatures(xi, eta);
      const auto S = shears(xi, eta);
      K += dA * (B.transpose() * bending_ * B + shear_ * S.transpose() * S);
    }
  }
  return K;
}

Eigen::Matrix<double, 5, 1> ShellPlate::forces(const PlateVector& displacements, double xi, double eta) const {
  Eigen::Matrix<double, 5, 1> result;
  result << bending_ * (curvatures(xi, eta) * displacements), shear_ * (shears(xi, eta) * displacements);
  return result;
}

}  // namespace topple::solver
