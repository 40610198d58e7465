// Stiffnesses of single elements, as they stand.
#include "assembly/frame_elements.h"
#include "elements/second_order_beam.h"

namespace topple::solver {

Mat12 FrameElements::rigid_end_stiffness(std::size_t i) const {
  if (second_order == nullptr) return CondensedBeam(model.beams[i], beam_factor[i]).stiffness();
  return SecondOrderBeam(model.beams[i], beam_factor[i], second_order->mode, second_order->first_axial[i],
                         second_order->loads[i], ends_apart(static_cast<int>(i)))
      .stiffness();
}

double FrameElements::ends_apart(int index) const {
  const Beam& beam = model.beams[static_cast<std::size_t>(index)];
  const auto place = [&](std::size_t end) -> Vec3 {
    return model.nodes[static_cast<std::size_t>(beam.node[end])] + beam.offset[end];
  };
  const double apart = (place(1) - place(0)).norm();
  constexpr double rounding = 1e-9;
  return apart > (1 + rounding) * beam.length ? apart : beam.length;
}

void FrameElements::add_diaphragm_arms(std::span<const int> nodes, Eigen::Ref<Eigen::MatrixXd> K) const {
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    if (dofs_.diaphragm_of_node[static_cast<std::size_t>(nodes[k])] < 0) continue;
    const Mat3 C = dofs_.diaphragm_arm(nodes[k]);
    const auto n = static_cast<Eigen::Index>(6 * k);
    K.middleRows<3>(n + 3) += C.transpose() * K.middleRows<3>(n);
    K.middleCols<3>(n + 3) += K.middleCols<3>(n) * C;
  }
}

Mat12 FrameElements::beam_stiffness(int index) const {
  const auto i = static_cast<std::size_t>(index);
  if (beam_stands[i] == 0) return Mat12::Zero();
  const Beam& beam = model.beams[i];
  std::array<Mat3, 2> arm;
  for (std::size_t end = 0; end < 2; ++end) {
    arm[end] = arm_matrix(beam.offset[end]) + dofs_.diaphragm_arm(beam.node[end]);
  }
  Mat12 K = to_node_freedoms(beam.axes, rigid_end_stiffness(i), arm);
  if (inertia != nullptr && beam.density != 0) K += inertia->factor * beam_mass(*this, inertia->masses, index);
  return K;
}

const Mat24& FrameElements::shell_node_stiffness(int index) const {
  if (const auto given = model.shell_stiffness.find(index); given != model.shell_stiffness.end()) return given->second;
  const Shell& shell = model.shells[static_cast<std::size_t>(index)];
  const std::array<Vec3, 4> corners = corner_places(shell, model.nodes);
  KeptShell& kept = kept_shells_[kept_shells_.size() > 1 ? static_cast<std::size_t>(index) : 0];
  const bool same = kept.shell.thickness == shell.thickness && kept.shell.youngs_modulus == shell.youngs_modulus &&
                    kept.shell.poisson_ratio == shell.poisson_ratio && kept.shell.bending == shell.bending &&
                    kept.corners == corners;
  if (!same) {
    kept.shell = shell;
    kept.corners = corners;
    kept.stiffness = ShellElement(shell, corners).stiffness();
  }
  return kept.stiffness;
}

Mat24 FrameElements::shell_stiffness(int index) const {
  const auto i = static_cast<std::size_t>(index);
  if (shell_stands[i] == 0) return Mat24::Zero();
  Mat24 K = shell_node_stiffness(index);
  if (shells_pushed() && jointed(index) == nullptr) K += shell_geometric_stiffness(index);
  if (inertia != nullptr && model.shells[i].density != 0)
    K += inertia->factor * shell_mass(*this, inertia->masses, index);
  add_diaphragm_arms(model.shells[i].node, K);
  return K;
}

Eigen::MatrixXd FrameElements::patch_node_stiffness(std::size_t patch) const {
  Eigen::MatrixXd K = model.patches[patch].stiffness;
  if (shells_pushed())
    if (const JointedShell* shell = jointed_shell_of_patch(second_order->jointed, static_cast<int>(patch)))
      K += shell->corners.transpose() * shell_geometric_stiffness(shell->shell) * shell->corners;
  leave_out_gone(model.patches[patch].node, K);
  return K;
}

Eigen::MatrixXd FrameElements::patch_node_mass(std::size_t patch) const {
  Eigen::MatrixXd M = model.patches[patch].mass;
  leave_out_gone(model.patches[patch].node, M);
  return M;
}

Eigen::MatrixXd FrameElements::patch_mass(std::size_t patch) const {
  Eigen::MatrixXd M = patch_node_mass(patch);
  add_diaphragm_arms(model.patches[patch].node, M);
  return M;
}

/// Rows and columns of nodes that no longer stand.
void FrameElements::leave_out_gone(std::span<const int> nodes, Eigen::MatrixXd& matrix) const {
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    if (node_stands[static_cast<std::size_t>(nodes[n])] != 0) continue;
    matrix.middleRows<6>(static_cast<Eigen::Index>(6 * n)).setZero();
    matrix.middleCols<6>(static_cast<Eigen::Index>(6 * n)).setZero();
  }
}

Eigen::MatrixXd FrameElements::patch_stiffness(int index) const {
  const auto i = static_cast<std::size_t>(index);
  Eigen::MatrixXd K = patch_node_stiffness(i);
  if (inertia != nullptr && model.patches[i].mass.size() > 0) K += inertia->factor * patch_node_mass(i);
  add_diaphragm_arms(model.patches[i].node, K);
  return K;
}

Eigen::MatrixXd FrameElements::plate_stiffness(std::size_t element) const {
  if (element < element_of_patch(0)) return shell_stiffness(static_cast<int>(element - element_of_shell(0)));
  return patch_stiffness(static_cast<int>(element - element_of_patch(0)));
}

std::span<const int> FrameElements::plate_nodes(std::size_t element) const {
  if (element < element_of_patch(0)) return model.shells[element - element_of_shell(0)].node;
  return model.patches[element - element_of_patch(0)].node;
}

const JointedShell* FrameElements::jointed(int shell) const {
  return second_order == nullptr ? nullptr : jointed_shell(second_order->jointed, shell);
}

Mat24 FrameElements::shell_geometric_stiffness(int index) const {
  const auto i = static_cast<std::size_t>(index);
  const Shell& shell = model.shells[i];
  Vec24 u = corner_displacements(index, second_order->shell_displacements);
  const Vec3 origin = u.head<3>();
  for (int n = 0; n < 4; ++n) u.segment<3>(6 * n) -= origin;
  const double strain = second_order->shell_strain.empty() ? 0 : second_order->shell_strain[i];
  return second_order->shell_factor *
         ShellElement(shell, corner_places(shell, model.nodes)).geometric_stiffness(u, strain);
}

}  // namespace topple::solver
