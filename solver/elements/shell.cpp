#include "elements/shell.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <stdexcept>
#include <string>

#include "elements/beam.h"

namespace topple::solver {
namespace {

/// Heights over the mean plane below this share of the diagonal are rounding of a flat quadrilateral.
constexpr double flat_limit = 1e-9;

Vec3 centre_of(const std::array<Vec3, 4>& p) { return (p[0] + p[1] + p[2] + p[3]) / 4; }

Mat3 element_axes(const std::array<Vec3, 4>& p) {
  const Vec3 normal = (p[2] - p[0]).cross(p[3] - p[1]).normalized();
  const auto in_plane = [&](const Vec3& v) -> Vec3 { return (v - v.dot(normal) * normal).normalized(); };
  const Vec3 along_xi = in_plane(p[1] + p[2] - p[0] - p[3]), along_eta = in_plane(p[2] + p[3] - p[0] - p[1]);
  // x and y lie as far from the middle lines on either side: the axes turn with the numbering of the nodes.
  const Vec3 diagonal = (along_xi + along_eta).normalized();
  const Vec3 x = (diagonal - normal.cross(diagonal)).normalized();
  Mat3 axes;
  axes << x.transpose(), normal.cross(x).transpose(), normal.transpose();
  return axes;
}

Quadrilateral project(const std::array<Vec3, 4>& p, const Mat3& axes) {
  const Vec3 centre = centre_of(p);
  Quadrilateral corners;
  for (std::size_t i = 0; i < 4; ++i) corners[i] = (axes * (p[i] - centre)).head<2>();
  return corners;
}

constexpr std::array<int, 3> membrane_components{0, 1, 5}, plate_components{2, 3, 4};

/// Index of freedom k of a part (three for each node) among the 24.
int index_of_component(const std::array<int, 3>& components, int k) {
  return 6 * (k / 3) + components[static_cast<std::size_t>(k % 3)];
}

Eigen::Matrix<double, 12, 1> part(const Vec24& all, const std::array<int, 3>& components) {
  Eigen::Matrix<double, 12, 1> result;
  for (int k = 0; k < 12; ++k) result(k) = all(index_of_component(components, k));
  return result;
}

void put(const Eigen::Matrix<double, 12, 12>& K, const std::array<int, 3>& components, Mat24& all) {
  for (int i = 0; i < 12; ++i) {
    for (int j = 0; j < 12; ++j) all(index_of_component(components, i), index_of_component(components, j)) = K(i, j);
  }
}

}  // namespace

std::array<Vec3, 4> corner_places(const Shell& shell, const std::vector<Vec3>& nodes) {
  std::array<Vec3, 4> p;
  const Vec3& origin = nodes[static_cast<std::size_t>(shell.node[0])];
  for (std::size_t i = 0; i < 4; ++i) p[i] = nodes[static_cast<std::size_t>(shell.node[i])] - origin;
  return p;
}

void check_shell(const Shell& shell, int index, const std::vector<Vec3>& nodes) {
  const auto refuse = [&](const std::string& what) {
    throw std::invalid_argument("shell " + std::to_string(index) + ": " + what);
  };
  for (int node : shell.node) {
    if (node < 0 || node >= static_cast<int>(nodes.size())) refuse("node " + std::to_string(node) + " does not exist");
  }
  if (!(shell.youngs_modulus > 0) || !std::isfinite(shell.youngs_modulus)) refuse("Young's modulus must be above 0");
  if (!(shell.thickness > 0) || !std::isfinite(shell.thickness)) refuse("thickness must be above 0");
  if (!(shell.poisson_ratio > -1 && shell.poisson_ratio <= 0.5))
    refuse("Poisson's ratio must be above -1 and at most 0.5");
  const std::array<Vec3, 4> p = corner_places(shell, nodes);
  const Mat3 axes = element_axes(p);
  constexpr double least_corner = 1e-6;  // sine of the sharpest corner over the square of the diagonals
  const double size = (p[2] - p[0]).norm() * (p[3] - p[1]).norm();
  bool convex = axes.allFinite();
  const Quadrilateral corners = project(p, axes);
  for (const auto& [xi, eta] : {std::pair(-1, -1), std::pair(1, -1), std::pair(1, 1), std::pair(-1, 1)}) {
    convex = convex && Bilinear(xi, eta).jacobian(corners).determinant() > least_corner * size;
  }
  if (!convex) refuse("its nodes must go round a convex quadrilateral");
}

ShellElement::ShellElement(const Shell& shell, const std::array<Vec3, 4>& nodes)
    : bending_(shell.bending),
      axes_(element_axes(nodes)),
      corners_(project(nodes, axes_)),
      membrane_(corners_, shell.youngs_modulus, shell.poisson_ratio, shell.thickness),
      plate_(corners_, shell.youngs_modulus, shell.poisson_ratio, shell.thickness) {
  const Vec3 normal = axes_.row(2), centre = centre_of(nodes);
  for (std::size_t i = 0; i < 4; ++i) {
    const double height = normal.dot(nodes[i] - centre);
    const bool flat = std::abs(height) < flat_limit * (nodes[2] - nodes[0]).norm();
    arm_[i] = flat ? Mat3::Zero() : arm_matrix(-height * normal);
  }
}

Vec24 ShellElement::to_local(const Vec24& global) const {
  Vec24 local;
  for (int n = 0; n < 4; ++n) {
    const Vec3 rotation = global.segment<3>(6 * n + 3);
    local.segment<3>(6 * n) = axes_ * (global.segment<3>(6 * n) + arm_[static_cast<std::size_t>(n)] * rotation);
    local.segment<3>(6 * n + 3) = axes_ * rotation;
  }
  return local;
}

Vec24 ShellElement::to_global(const Vec24& local) const {
  Vec24 global;
  for (int n = 0; n < 4; ++n) {
    const Vec3 force = axes_.transpose() * local.segment<3>(6 * n);
    global.segment<3>(6 * n) = force;
    global.segment<3>(6 * n + 3) =
        axes_.transpose() * local.segment<3>(6 * n + 3) + arm_[static_cast<std::size_t>(n)].transpose() * force;
  }
  return global;
}

Mat24 ShellElement::stiffness() const {
  Mat24 local = Mat24::Zero();
  put(membrane_.stiffness(), membrane_components, local);
  if (bending_) put(plate_.stiffness(), plate_components, local);
  return to_global(local);
}

Mat24 ShellElement::to_global(const Mat24& local) const {
  Mat24 K;
  for (int i = 0; i < 8; ++i) {
    for (int j = i; j < 8; ++j) {
      const Mat3 block = axes_.transpose() * (local.block<3, 3>(3 * i, 3 * j) * axes_);
      K.block<3, 3>(3 * i, 3 * j) = block;
      if (i != j) K.block<3, 3>(3 * j, 3 * i) = block.transpose();
    }
  }
  add_arms(K);
  return K;
}

void ShellElement::add_arms(Mat24& K) const {
  for (int n = 0; n < 4; ++n) {
    const Mat3& C = arm_[static_cast<std::size_t>(n)];
    if ((C.array() == 0).all()) continue;
    K.middleRows<3>(6 * n + 3) += C.transpose() * K.middleRows<3>(6 * n);
    K.middleCols<3>(6 * n + 3) += K.middleCols<3>(6 * n) * C;
  }
}

Vec24 ShellElement::fixed_forces(const Vec3& traction, double strain) const {
  Vec24 local = Vec24::Zero();
  const MembraneVector from_strain = membrane_.strain_forces(strain);
  for (int k = 0; k < 12; ++k) local(index_of_component(membrane_components, k)) = from_strain(k);
  const Vec3 local_traction = axes_ * traction;
  for (double xi : gauss2) {
    for (double eta : gauss2) {
      const Bilinear shape(xi, eta);
      const double dA = shape.jacobian(corners_).determinant();
      for (int n = 0; n < 4; ++n) local.segment<3>(6 * n) -= dA * shape.N(n) * local_traction;
      // Edges bulge with the difference of their ends' drilling rotations (shell_membrane.h); inside, a bulge fades
      // linearly towards the opposite edge. Without its work a column of elements would not stand under its own weight
      // as a bar does.
      const std::array<double, 4> bulge{(1 - xi * xi) * (1 - eta), (1 - eta * eta) * (1 + xi),
                                        (1 - xi * xi) * (1 + eta), (1 - eta * eta) * (1 - xi)};
      for (std::size_t i = 0; i < 4; ++i) {
        const std::size_t j = (i + 1) % 4;
        const Vec2 along = corners_[j] - corners_[i];
        const double work = dA * bulge[i] / 16 * (along.y() * local_traction.x() - along.x() * local_traction.y());
        local(static_cast<Eigen::Index>(6 * j + 5)) -= work;
        local(static_cast<Eigen::Index>(6 * i + 5)) += work;
      }
    }
  }
  return to_global(local);
}

Eigen::Matrix<double, 8, 1> ShellElement::resultants(const Vec24& displacements, double strain, const Vec2& at) const {
  const Vec24 local = to_local(displacements);
  Eigen::Matrix<double, 8, 1> result = Eigen::Matrix<double, 8, 1>::Zero();
  result.head<3>() =
      membrane_.forces(part(local, membrane_components), strain, Bilinear(at.x(), at.y()).position(corners_));
  if (bending_) result.tail<5>() = plate_.forces(part(local, plate_components), at.x(), at.y());
  return result;
}

}  // namespace topple::solver
