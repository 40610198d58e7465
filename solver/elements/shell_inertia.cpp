// Mass and geometric stiffness of a shell: by the bilinear shapes of its three translations.
#include <Eigen/LU>

#include "elements/shell.h"

namespace topple::solver {

/// `entry(a, b)` on all three translations of nodes a and b, then the arms of a warped quadrilateral.
Mat24 ShellElement::on_translations(const Eigen::Matrix4d& entry) const {
  Mat24 K = Mat24::Zero();
  for (int a = 0; a < 4; ++a)
    for (int b = 0; b < 4; ++b) K.block<3, 3>(6 * a, 6 * b) = entry(a, b) * Mat3::Identity();
  add_arms(K);
  return K;
}

Mat24 ShellElement::mass(double per_area, bool lumped) const {
  Eigen::Matrix4d m = Eigen::Matrix4d::Zero();
  for (const double xi : gauss2)
    for (const double eta : gauss2) {
      const Bilinear shape(xi, eta);
      const double dm = per_area * shape.jacobian(corners_).determinant();
      if (lumped)
        m.diagonal() += dm * shape.N;
      else
        m += dm * shape.N * shape.N.transpose();
    }
  return on_translations(m);
}

Mat24 ShellElement::rotary_mass(double per_area) const {
  Mat24 local = Mat24::Zero();
  for (const double xi : gauss2)
    for (const double eta : gauss2) {
      const Bilinear shape(xi, eta);
      const Eigen::Matrix2d jacobian = shape.jacobian(corners_);
      Eigen::Matrix<double, 2, 4> derivatives;
      derivatives << shape.dxi.transpose(), shape.deta.transpose();
      const Eigen::Matrix<double, 2, 4> gradient = jacobian.inverse() * derivatives;
      Eigen::Matrix<double, 3, 24> turns = Eigen::Matrix<double, 3, 24>::Zero();
      for (int n = 0; n < 4; ++n) {
        for (int c = 0; c < 3; ++c) turns(c, 6 * n + 3 + c) = shape.N(n);
        turns(2, 6 * n) = gradient(1, n) / 2;
        turns(2, 6 * n + 1) = -gradient(0, n) / 2;
      }
      local += per_area * jacobian.determinant() * turns.transpose() * turns;
    }
  return to_global(local);
}

Mat24 ShellElement::geometric_stiffness(const Vec24& displacements, double strain) const {
  const Vec24 local = to_local(displacements);
  MembraneVector u;
  for (int node = 0; node < 4; ++node)
    u.segment<3>(3 * node) << local(6 * node), local(6 * node + 1), local(6 * node + 5);
  Eigen::Matrix4d k = Eigen::Matrix4d::Zero();
  for (const double xi : gauss2)
    for (const double eta : gauss2) {
      const Bilinear shape(xi, eta);
      const Eigen::Matrix2d jacobian = shape.jacobian(corners_);
      const Eigen::Vector3d n = membrane_.forces(u, strain, shape.position(corners_));
      Eigen::Matrix2d N;
      N << n(0), n(2), n(2), n(1);
      Eigen::Matrix<double, 2, 4> derivatives;
      derivatives << shape.dxi.transpose(), shape.deta.transpose();
      const Eigen::Matrix<double, 2, 4> gradient = jacobian.inverse() * derivatives;
      k += jacobian.determinant() * gradient.transpose() * N * gradient;
    }
  return on_translations(k);
}

}  // namespace topple::solver
