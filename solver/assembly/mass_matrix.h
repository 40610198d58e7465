#pragma once
// Mass of a frame system in its scaled equations, beside its stiffness: S M S on the same pattern.
#include <Eigen/Core>

#include "assembly/frame_system.h"
#include "topple/solver/modes.h"

namespace topple::solver {

class MassMatrix {
 public:
  /// Throws std::invalid_argument for a mass at a node that does not exist or a negative one.
  MassMatrix(const FrameSystem& system, const MassModel& masses, int threads = 1);

  [[nodiscard]] const SparseSymmetric& matrix() const { return matrix_; }
  [[nodiscard]] Eigen::MatrixXd times(const Eigen::Ref<const Eigen::MatrixXd>& x) const;
  /// Scaled equations of a unit translation along x, y, z and of a unit rotation about x, y, z through `centre`.
  [[nodiscard]] Eigen::VectorXd rigid_motion(int component, const Vec3& centre) const;
  /// Of the mass that is free to move along each axis.
  [[nodiscard]] Vec3 centre() const;

 private:
  void add_shell(int shell, const MassModel& masses);
  void add_node(int node, const Vec6& diagonal);
  const FrameSystem& system_;
  int threads_;
  std::vector<JointedShell> jointed_;
  SparseSymmetric matrix_;
};

/// y += A x for the whole of a symmetric matrix given by its lower triangle.
void multiply_symmetric(const SparseSymmetric& A, const Eigen::Ref<const Eigen::MatrixXd>& x, Eigen::MatrixXd& y,
                        int threads = 1);

}  // namespace topple::solver
