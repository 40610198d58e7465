#include "elements/shell_membrane.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>

namespace topple::solver {

Bilinear::Bilinear(double xi, double eta) {
  const Eigen::Vector4d sx(-1, 1, 1, -1), sy(-1, -1, 1, 1);
  for (int i = 0; i < 4; ++i) {
    const double fx = 1 + sx(i) * xi, fy = 1 + sy(i) * eta;
    N(i) = fx * fy / 4;
    dxi(i) = sx(i) * fy / 4;
    deta(i) = sy(i) * fx / 4;
  }
}

Eigen::Matrix2d Bilinear::jacobian(const Quadrilateral& corners) const {
  Eigen::Matrix2d J = Eigen::Matrix2d::Zero();
  for (int i = 0; i < 4; ++i) {
    J.row(0) += dxi(i) * corners[static_cast<std::size_t>(i)].transpose();
    J.row(1) += deta(i) * corners[static_cast<std::size_t>(i)].transpose();
  }
  return J;
}

Vec2 Bilinear::position(const Quadrilateral& corners) const {
  Vec2 p = Vec2::Zero();
  for (int i = 0; i < 4; ++i) p += N(i) * corners[static_cast<std::size_t>(i)];
  return p;
}

ShellMembrane::ShellMembrane(const Quadrilateral& corners, double youngs_modulus, double poisson_ratio,
                             double thickness)
    : corners_(corners), shear_stiffness_(youngs_modulus * thickness / (2 * (1 + poisson_ratio))) {
  compliance_ << 1, -poisson_ratio, 0, -poisson_ratio, 1, 0, 0, 0, 2 * (1 + poisson_ratio);
  compliance_ /= youngs_modulus * thickness;
  size_ = ((corners[2] - corners[0]).norm() + (corners[3] - corners[1]).norm()) / 4;
  integrate_flexibility();
  integrate_edges();
  tie_rotations();
}

ShellMembrane::Modes ShellMembrane::stress_modes(const Vec2& at) const {
  const double x = at.x() / size_, y = at.y() / size_;
  Modes P;
  P << 1, 0, 0, y, 0, x, 0, y * y, 0,  //
      0, 1, 0, 0, x, 0, y, 0, x * x,   //
      0, 0, 1, 0, 0, -y, -x, 0, 0;
  return P;
}

// The integrand has degree four in x, y: three by three points are exact.
void ShellMembrane::integrate_flexibility() {
  Eigen::Matrix<double, modes, modes> H = Eigen::Matrix<double, modes, modes>::Zero();
  unit_strain_work_.setZero();
  rotation_gap_.setZero();
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      const Bilinear shape(gauss3[i], gauss3[j]);
      const double dA = shape.jacobian(corners_).determinant() * gauss3_weight[i] * gauss3_weight[j];
      const Modes P = stress_modes(shape.position(corners_));
      H += dA * P.transpose() * compliance_ * P;
      unit_strain_work_ += dA * P.transpose() * Eigen::Vector3d(1, 1, 0);
      for (int n = 0; n < 4; ++n) rotation_gap_(3 * n + 2) += dA * shape.N(n);
      area_ += dA;
    }
  }
  rotation_gap_ /= area_;
  flexibility_inverse_ = H.llt().solve(Eigen::Matrix<double, modes, modes>::Identity());
}

void ShellMembrane::integrate_edges() {
  edge_work_.setZero();
  for (int i = 0; i < 4; ++i) {
    const int j = (i + 1) % 4;
    const Vec2 along = corners_[static_cast<std::size_t>(j)] - corners_[static_cast<std::size_t>(i)];
    const Vec2 outward(along.y(), -along.x());  // times the edge's length
    for (std::size_t g = 0; g < 3; ++g) {
      const double s = (1 + gauss3[g]) / 2, weight = gauss3_weight[g] / 2;
      const Modes P = stress_modes(corners_[static_cast<std::size_t>(i)] + s * along);
      Eigen::Matrix<double, 2, modes> traction;  // times the edge's length
      traction.row(0) = outward.x() * P.row(0) + outward.y() * P.row(2);
      traction.row(1) = outward.x() * P.row(2) + outward.y() * P.row(1);
      const Eigen::Matrix<double, modes, 1> bulge = traction.transpose() * outward * (s * (1 - s) / 2);
      edge_work_.middleCols<2>(3 * i) += weight * (1 - s) * traction.transpose();
      edge_work_.middleCols<2>(3 * j) += weight * s * traction.transpose();
      edge_work_.col(3 * j + 2) += weight * bulge;
      edge_work_.col(3 * i + 2) -= weight * bulge;
    }
  }
}

/// The element's own mean rotation is half the circulation of the edge displacements over the area; the normal bulges
/// do not circulate.
void ShellMembrane::tie_rotations() {
  for (int i = 0; i < 4; ++i) {
    const int j = (i + 1) % 4;
    const Vec2 along = corners_[static_cast<std::size_t>(j)] - corners_[static_cast<std::size_t>(i)];
    for (int node : {i, j}) {
      rotation_gap_(3 * node) -= along.x() / (4 * area_);
      rotation_gap_(3 * node + 1) -= along.y() / (4 * area_);
    }
  }
}

MembraneMatrix ShellMembrane::stiffness() const {
  return edge_work_.transpose() * flexibility_inverse_ * edge_work_ +
         shear_stiffness_ * area_ * rotation_gap_.transpose() * rotation_gap_;
}

MembraneVector ShellMembrane::strain_forces(double strain) const {
  return -strain * (edge_work_.transpose() * (flexibility_inverse_ * unit_strain_work_));
}

Eigen::Vector3d ShellMembrane::forces(const MembraneVector& displacements, double strain, const Vec2& at) const {
  return stress_modes(at) * (flexibility_inverse_ * (edge_work_ * displacements - strain * unit_strain_work_));
}

}  // namespace topple::solver
