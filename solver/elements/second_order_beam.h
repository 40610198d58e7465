#pragma once
// A beam in its second-order state: stiffness and fixed-end forces with its axial force, from the exact beam-column or
// the cubic geometric stiffness.
#include "elements/beam.h"
#include "elements/beam_column.h"
#include "topple/solver/second_order.h"

namespace topple::solver {

class SecondOrderBeam {
 public:
  /// `ends_apart`: for Frame3DD, whose geometric stiffness is that of the whole distance between the nodes where radii
  /// make the beam shorter; 0: the beam's length.
  SecondOrderBeam(const Beam& beam, double factor, SecondOrder mode, double first_axial,
                  std::span<const BeamLoad> loads, double ends_apart = 0);
  /// Local axes, freedoms of the rigid ends.
  [[nodiscard]] const Mat12& stiffness() const { return stiffness_; }
  [[nodiscard]] const FixedEndForces& fixed_end_forces() const { return fixed_; }
  [[nodiscard]] int buckled_modes() const { return in_xy_.buckled_modes() + in_xz_.buckled_modes(); }
  [[nodiscard]] const BeamColumn& in_xy() const { return in_xy_; }
  [[nodiscard]] const BeamColumn& in_xz() const { return in_xz_; }

 private:
  void make_cubic(const Beam& beam, double factor, double axial, double geometric_length);
  Mat12 stiffness_ = Mat12::Zero();
  FixedEndForces fixed_;
  BeamColumn in_xy_, in_xz_;
};

/// Whether a beam is far from buckling between its ends held, without its stiffness being worked out: these buckle at
/// 4 pi2 EI/L2 (less by shear) under an even force; axial loads along it are added to what presses. `axial`: tension at
/// the first end.
[[nodiscard]] bool far_from_buckling_inside(const Beam& beam, double axial, std::span<const BeamLoad> loads);

/// The end forces that Frame3DD prints: its geometric part goes with the axial force of the elastic strain, E A times
/// the change of length, which leaves out loads along the element and thermal strain; torsion has no such part.
[[nodiscard]] Vec12 frame3dd_end_forces(const Beam& beam, const Vec12& rigid_end_displacements, const Vec12& fixed_end,
                                        double ends_apart);

/// Free strain of each shell under these loads.
[[nodiscard]] std::vector<double> shell_strains(const FrameModel& model, const LoadSet& loads);

/// Freedoms of the two bending planes, v1 r1 v2 r2; in the x-z plane rotations and moments change sign.
inline constexpr std::array<int, 4> xy_plane{1, 5, 7, 11}, xz_plane{2, 4, 8, 10};
[[nodiscard]] Eigen::Vector4d plane_part(const Vec12& all, bool xz);

}  // namespace topple::solver
