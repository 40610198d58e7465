#pragma once
// Flat four-node shell in space: membrane with drilling, plate when `bending`. Nodes off the mean plane hang on it by
// rigid arms along the normal, so that a warped quadrilateral stays in equilibrium.
#include "elements/shell_membrane.h"
#include "elements/shell_plate.h"
#include "topple/solver/frame_model.h"

namespace topple::solver {

using Vec24 = Eigen::Matrix<double, 24, 1>;
using Mat24 = Eigen::Matrix<double, 24, 24>;

/// Throws std::invalid_argument, naming the shell by its index.
void check_shell(const Shell& shell, int index, const std::vector<Vec3>& nodes);

class ShellElement {
 public:
  ShellElement(const Shell& shell, const std::array<Vec3, 4>& nodes);

  /// Global freedoms of its nodes, in order.
  [[nodiscard]] Mat24 stiffness() const;
  /// Forces of the nodes on the shell with all nodes held: against the traction (global, per area), from a free strain.
  [[nodiscard]] Vec24 fixed_forces(const Vec3& traction, double strain) const;
  /// Mass in the three translations, none in the rotations; bilinear shapes, or lumped at the nodes by them.
  [[nodiscard]] Mat24 mass(double per_area, bool lumped) const;
  /// Of inertia per area (kg): for rotations about axes in the plane, and for drilling rotations beyond that of the
  /// plane as it moves.
  [[nodiscard]] Mat24 rotary_mass(double per_area) const;
  /// Of the membrane forces at these displacements (global): what they do to the gradient of all three translations.
  [[nodiscard]] Mat24 geometric_stiffness(const Vec24& displacements, double strain) const;
  /// Rows: element axes; x, y halve the angle between the element's middle lines.
  [[nodiscard]] const Mat3& axes() const { return axes_; }
  /// nx, ny, nxy; mx, my, mxy; qx, qy at natural coordinates (-1 to 1), element axes.
  [[nodiscard]] Eigen::Matrix<double, 8, 1> resultants(const Vec24& displacements, double strain,
                                                       const Vec2& at = Vec2::Zero()) const;

 private:
  [[nodiscard]] Vec24 to_local(const Vec24& global) const;
  [[nodiscard]] Vec24 to_global(const Vec24& local) const;
  [[nodiscard]] Mat24 to_global(const Mat24& local) const;  ///< symmetric
  [[nodiscard]] Mat24 on_translations(const Eigen::Matrix4d& entry) const;
  void add_arms(Mat24& K) const;  ///< of a warped quadrilateral, whose nodes lie off its plane

  bool bending_;
  Mat3 axes_;
  Quadrilateral corners_;
  std::array<Mat3, 4> arm_;  ///< translation of the corner in the plane per rotation of the node, global
  ShellMembrane membrane_;
  ShellPlate plate_;
};

/// Nodes of a shell, seen from the first: congruent shells are equal to the bit wherever they stand.
[[nodiscard]] std::array<Vec3, 4> corner_places(const Shell& shell, const std::vector<Vec3>& nodes);

}  // namespace topple::solver
