#include "eigen/element_modes.h"

#include <Eigen/Eigenvalues>
#include <array>
#include <cmath>

namespace topple::solver {
namespace {

/// Keeps the rows of freedoms that are equations, scaled.
ElementModes in_equations(const FrameSystem& system, std::size_t element, const Eigen::MatrixXd& B) {
  ElementModes modes;
  const auto freedoms = system.assembly_map().freedoms(element);
  modes.B.resize(B.rows(), B.cols());
  Eigen::Index kept = 0;
  for (std::size_t k = 0; k < freedoms.size(); ++k) {
    if (freedoms[k] >= system.dofs().equations) continue;
    modes.rows.push_back(freedoms[k]);
    modes.B.row(kept++) = system.scale()[static_cast<std::size_t>(freedoms[k])] * B.row(static_cast<Eigen::Index>(k));
  }
  modes.B.conservativeResize(kept, Eigen::NoChange);
  return modes;
}

/// Of a beam's 12 freedoms those that are equations.
int equations_of_beam(const FrameSystem& system, int beam, std::array<int, 12>& kept) {
  const auto freedoms = system.assembly_map().freedoms(static_cast<std::size_t>(beam));
  std::size_t count = 0;
  for (std::size_t k = 0; k < 12; ++k)
    if (freedoms[k] < system.dofs().equations) kept[count++] = static_cast<int>(k);
  return static_cast<int>(count);
}

}  // namespace

ElementModes beam_modes(const FrameSystem& system, int index) {
  if (system.inertia != nullptr) {
    std::array<int, 12> kept{};
    const int count = equations_of_beam(system, index, kept);
    Eigen::MatrixXd own = Eigen::MatrixXd::Zero(12, count);
    for (int k = 0; k < count; ++k) own(kept[static_cast<std::size_t>(k)], k) = 1;
    return in_equations(system, static_cast<std::size_t>(index), own);
  }
  const Beam& beam = system.model.beams[static_cast<std::size_t>(index)];
  // Columns: the reverse rigid-body forces at the first end, unit forces at the second, local axes.
  Eigen::Matrix<double, 12, 6> local = Eigen::Matrix<double, 12, 6>::Zero();
  local.topRows<6>() = -Mat6::Identity();
  local(5, 1) = -beam.length;
  local(4, 2) = beam.length;
  local.bottomRows<6>() = Mat6::Identity();
  Eigen::MatrixXd B(12, 6);
  for (int end = 0; end < 2; ++end) {
    const auto e = static_cast<std::size_t>(end);
    const Mat3 arm = arm_matrix(beam.offset[e]) + system.dofs().diaphragm_arm(beam.node[e]);
    const Eigen::Matrix<double, 3, 6> force = beam.axes.transpose() * local.middleRows<3>(6 * end);
    B.middleRows<3>(6 * end) = force;
    B.middleRows<3>(6 * end + 3) = beam.axes.transpose() * local.middleRows<3>(6 * end + 3) + arm.transpose() * force;
  }
  return in_equations(system, static_cast<std::size_t>(index), B);
}

BeamModeMatrix beam_mode_stiffness(const FrameSystem& system, int index) {
  const auto i = static_cast<std::size_t>(index);
  if (system.inertia != nullptr) {
    std::array<int, 12> kept{};
    const int count = equations_of_beam(system, index, kept);
    const Mat12 A = system.beam_stiffness(index);
    BeamModeMatrix D(count, count);
    for (int r = 0; r < count; ++r)
      for (int c = 0; c < count; ++c) D(r, c) = A(kept[static_cast<std::size_t>(r)], kept[static_cast<std::size_t>(c)]);
    return D;
  }
  if (system.beam_stands[i] == 0) return Mat6::Zero();
  return CondensedBeam(system.model.beams[i], system.beam_factor[i]).stiffness().bottomRightCorner<6, 6>();
}

ElementModes shell_modes(const FrameSystem& system, const Mat24& stiffness, int shell) {
  // Eigenvalues below this share of the largest are the rigid motions' rounding.
  constexpr double rigid_motion = 1e-13;
  const Eigen::MatrixXd K = stiffness;  // at dynamic size: the fixed one takes minutes to compile
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> modes(K);
  const Eigen::VectorXd& values = modes.eigenvalues();
  Eigen::Index first = 0;
  while (first < values.size() && values(first) <= rigid_motion * values(values.size() - 1)) ++first;
  const Eigen::Index count = values.size() - first;
  const Eigen::MatrixXd B = modes.eigenvectors().rightCols(count) * values.tail(count).cwiseSqrt().asDiagonal();
  return in_equations(system, system.model.beams.size() + static_cast<std::size_t>(shell), B);
}

ElementModes node_modes(const FrameSystem& system, int node) {
  ElementModes modes;
  const auto& first = system.dofs().first_equation;
  const auto n = static_cast<std::size_t>(node);
  for (int e = first[n]; e < first[n + 1]; ++e) modes.rows.push_back(e);
  const auto count = static_cast<Eigen::Index>(modes.rows.size());
  modes.B = Eigen::MatrixXd::Identity(count, count);
  return modes;
}

}  // namespace topple::solver
