#pragma once
// A beam's flexibility in one plane (or along its axis) with the springs and releases of its two ends condensed
// exactly.
//
// Force method: the basic forces are those at the first end; every end force follows from them by statics, so a
// released component is a condition on basic forces, never a subtraction of nearly equal stiffnesses. Which
// combinations of releases leave a loose motion is therefore decided by counting, without a tolerance.
#include <Eigen/Core>
#include <array>

namespace topple::solver {

/// Spring and release of one freedom: compliance 1/k, infinite when released.
[[nodiscard]] double spring_compliance(double stiffness);

/// Axial force or torsion: freedoms are the two ends.
class AxialEnds {
 public:
  AxialEnds(double flexibility, const std::array<double, 2>& end_stiffness);
  [[nodiscard]] double stiffness() const { return stiffness_; }
  [[nodiscard]] bool loose() const { return released_[0] && released_[1]; }
  /// End forces with both nodes held. `statics` is the force at the second end when the first end is free;
  /// `deformation` the displacement of the first end relative to the second in that state. What a loose bar cannot
  /// carry is added to `unbalanced`.
  [[nodiscard]] std::array<double, 2> fixed_end_forces(double statics, double deformation, double& unbalanced) const;

 private:
  double stiffness_ = 0, flexibility_ = 0;
  std::array<double, 2> compliance_{};
  std::array<bool, 2> released_{};
};

/// Bending in one plane: freedoms are v1, r1, v2, r2. `sense` is +1 where v' = r (local x-y plane), -1 where w' = -r.
class BendingEnds {
 public:
  /// `shear_flexibility` is L/(G As), or 0.
  BendingEnds(double length, double bending_stiffness, double shear_flexibility, double sense,
              const std::array<double, 4>& end_stiffness);
  [[nodiscard]] Eigen::Matrix4d stiffness() const;
  [[nodiscard]] bool loose() const { return loose_; }
  /// End forces with both nodes held. `statics`: force and moment at the second end when the first end is free;
  /// `deformation`: displacement and rotation of the second end in that state, seen from the first.
  [[nodiscard]] Eigen::Vector4d fixed_end_forces(const Eigen::Vector2d& statics, const Eigen::Vector2d& deformation,
                                                 double& unbalanced) const;

 private:
  void choose_basis();

  double length_, sense_;
  std::array<double, 4> compliance_{};
  std::array<int, 2> basis_{};               ///< freedoms whose forces are the unknowns
  Eigen::Matrix<double, 4, 2> end_forces_;   ///< forces at the freedoms per unit unknown (entries -1, 0, 1)
  Eigen::Matrix2d to_unknowns_;              ///< (V, M/L) at the first end per unit unknown
  Eigen::Matrix2d flexibility_, stiffness_;  ///< in the unknowns
  int released_ = 0;                         ///< leading unknowns whose force is prescribed by a release
  bool loose_ = false;
};

}  // namespace topple::solver
