#pragma once
// Membrane of a four-node quadrilateral with a true drilling freedom at each node.
//
// Assumed stress (Pian's hybrid method): nine stress modes in equilibrium (Airy functions of degree 2, 3 and two of
// degree 4) inside, displacements on the edges alone: linear along an edge, with a normal parabola from the difference
// of the drilling rotations of its ends (Allman 1984; the nine modes are those of Aminpour 1992). Edges fit their
// neighbours, so constant stress is exact on any quadrilateral; bending in the plane does not lock. The one motion that
// the edges do not see, all four drilling rotations alike, is tied to the mean rotation of the element (Hughes and
// Brezzi 1989) with the shear modulus.
#include <Eigen/Core>
#include <array>

namespace topple::solver {

using Vec2 = Eigen::Vector2d;
using Quadrilateral = std::array<Vec2, 4>;
/// Per node u, v, drilling rotation.
using MembraneMatrix = Eigen::Matrix<double, 12, 12>;
using MembraneVector = Eigen::Matrix<double, 12, 1>;

class ShellMembrane {
 public:
  /// Corners counter-clockwise in the element's plane, about its centre.
  ShellMembrane(const Quadrilateral& corners, double youngs_modulus, double poisson_ratio, double thickness);

  [[nodiscard]] MembraneMatrix stiffness() const;
  /// Nodal forces with all nodes held that a free strain, equal in all directions, brings about.
  [[nodiscard]] MembraneVector strain_forces(double strain) const;
  /// Forces per length nx, ny, nxy at a point (element axes).
  [[nodiscard]] Eigen::Vector3d forces(const MembraneVector& displacements, double strain, const Vec2& at) const;

 private:
  static constexpr int modes = 9;
  using Modes = Eigen::Matrix<double, 3, modes>;
  [[nodiscard]] Modes stress_modes(const Vec2& at) const;
  void integrate_flexibility();
  void integrate_edges();
  void tie_rotations();

  Quadrilateral corners_;
  double size_;                 ///< half a typical width: stress modes are in coordinates over it
  double shear_stiffness_ = 0;  ///< G t
  double area_ = 0;
  Eigen::Matrix3d compliance_;  ///< strain per force per length
  Eigen::Matrix<double, modes, modes> flexibility_inverse_;
  Eigen::Matrix<double, modes, 12> edge_work_;        ///< work of each stress mode on the edges' displacements
  Eigen::Matrix<double, modes, 1> unit_strain_work_;  ///< on a free strain of 1
  Eigen::Matrix<double, 1, 12> rotation_gap_;         ///< mean drilling rotation less the element's own
};

/// Bilinear shape functions, their derivatives by xi and eta, and Gauss points on [-1, 1].
struct Bilinear {
  Eigen::Vector4d N, dxi, deta;
  Bilinear(double xi, double eta);
  /// Rows: derivatives of x, y by xi, then by eta.
  [[nodiscard]] Eigen::Matrix2d jacobian(const Quadrilateral& corners) const;
  [[nodiscard]] Vec2 position(const Quadrilateral& corners) const;
};
inline constexpr std::array<double, 2> gauss2{-0.57735026918962576451, 0.57735026918962576451};
inline constexpr std::array<double, 3> gauss3{-0.77459666924148337704, 0, 0.77459666924148337704};
inline constexpr std::array<double, 3> gauss3_weight{5.0 / 9, 8.0 / 9, 5.0 / 9};

}  // namespace topple::solver
