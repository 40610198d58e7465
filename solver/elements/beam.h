#pragma once
// Exact Timoshenko beam-column between two nodes: end springs and releases condensed, rigid arms, fixed-end forces.
// Przemieniecki, Theory of Matrix Structural Analysis, ch. 5, with the force method of beam_end_springs.h.
#include <span>

#include "elements/beam_end_springs.h"
#include "topple/solver/frame_model.h"
#include "topple/solver/geometric_forces.h"

namespace topple::solver {

/// Throws std::invalid_argument, naming the beam by its index, for anything the formulas cannot use.
void check_beam(const Beam& beam, int index, int node_count);

/// Fixed-end forces, and how much of the load a loose part of the beam could not hand on (0 when all went to the
/// nodes).
struct FixedEndForces {
  Vec12 force = Vec12::Zero();
  double unbalanced = 0;
};

class CondensedBeam {
 public:
  /// `factor` multiplies E and G.
  explicit CondensedBeam(const Beam& beam, double factor = 1);

  /// Local axes, first end then second; displacements are those of the nodes' rigid ends at the beam's ends.
  [[nodiscard]] Mat12 stiffness() const;
  /// End forces with both rigid ends held, local axes.
  [[nodiscard]] FixedEndForces fixed_end_forces(std::span<const BeamLoad> loads) const;

  /// Every component of both ends is released: the beam is not there.
  [[nodiscard]] bool absent() const { return absent_; }
  /// Free to turn about its own axis: harmless, unless a torque acts on it.
  [[nodiscard]] bool spins() const { return torsion_.loose(); }
  /// Released so that it can move by itself, other than turning about its axis.
  [[nodiscard]] bool loose() const { return !absent_ && (axial_.loose() || in_xy_.loose() || in_xz_.loose()); }

 private:
  const Beam& beam_;
  double factor_;
  AxialEnds axial_, torsion_;
  BendingEnds in_xy_, in_xz_;
  bool absent_;
};

/// End forces per relative_motion(): the columns of the stiffness that belong to the second end.
using BeamStrainStiffness = Eigen::Matrix<double, 12, 6>;
[[nodiscard]] BeamStrainStiffness strain_stiffness(const CondensedBeam& beam);

/// End force from displacements of the rigid ends and fixed-end forces, local axes.
[[nodiscard]] Vec12 beam_end_forces(const CondensedBeam& beam, double length, const Vec12& rigid_end_displacements,
                                    const Vec12& fixed_end);

/// What the second end moves beyond the rigid motion of the first, local axes: all that strains the beam.
[[nodiscard]] Vec6 relative_motion(double length, const Vec12& rigid_end_displacements);

/// K in global node freedoms from K in local rigid end freedoms. `arm[end]` maps the node's rotations to the
/// translation of the beam's end: minus the cross matrix of the rigid arm, plus what a diaphragm adds.
[[nodiscard]] Mat12 to_node_freedoms(const Mat3& axes, const Mat12& local, const std::array<Mat3, 2>& arm);
/// Minus the cross matrix: translation of the tip of an arm per rotation of its root.
[[nodiscard]] Mat3 arm_matrix(const Vec3& arm);

}  // namespace topple::solver
