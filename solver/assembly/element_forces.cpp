// Forces of single elements, as they stand.
#include "assembly/frame_elements.h"
#include "elements/second_order_beam.h"

namespace topple::solver {

FixedEndForces FrameElements::fixed_end_forces(int beam, std::span<const BeamLoad> loads) const {
  const auto i = static_cast<std::size_t>(beam);
  if (beam_stands[i] == 0) return {};
  if (second_order != nullptr)
    return SecondOrderBeam(model.beams[i], beam_factor[i], second_order->mode, second_order->first_axial[i], loads)
        .fixed_end_forces();
  return CondensedBeam(model.beams[i], beam_factor[i]).fixed_end_forces(loads);
}

Vec12 FrameElements::end_forces(int index, const std::vector<Vec6>& displacements, const Vec12& fixed_end) const {
  const auto i = static_cast<std::size_t>(index);
  if (beam_stands[i] == 0) return Vec12::Zero();
  const Beam& beam = model.beams[i];
  const Vec12 rigid_ends = rigid_end_displacements(beam, displacements[static_cast<std::size_t>(beam.node[0])],
                                                   displacements[static_cast<std::size_t>(beam.node[1])]);
  if (second_order != nullptr) {
    // Only a translation of the whole costs nothing: turned, the axial force pushes sideways.
    Vec12 moved = rigid_ends;
    moved.segment<3>(0) -= rigid_ends.head<3>();
    moved.segment<3>(6) -= rigid_ends.head<3>();
    return rigid_end_stiffness(i) * moved + fixed_end;
  }
  return beam_end_forces(CondensedBeam(beam, beam_factor[i]), beam.length, rigid_ends, fixed_end);
}

Vec24 FrameElements::corner_displacements(int index, const std::vector<Vec6>& displacements) const {
  const JointedShell* hung = jointed(index);
  if (hung == nullptr) {
    Vec24 u;
    const auto& nodes = model.shells[static_cast<std::size_t>(index)].node;
    for (int n = 0; n < 4; ++n)
      u.segment<6>(6 * n) = displacements[static_cast<std::size_t>(nodes[static_cast<std::size_t>(n)])];
    return u;
  }
  const std::vector<int>& nodes = model.patches[static_cast<std::size_t>(hung->patch)].node;
  Eigen::VectorXd all(static_cast<Eigen::Index>(6 * nodes.size()));
  for (std::size_t n = 0; n < nodes.size(); ++n)
    all.segment<6>(static_cast<Eigen::Index>(6 * n)) = displacements[static_cast<std::size_t>(nodes[n])];
  return hung->corners * all;
}

std::array<Vec6, 4> FrameElements::corner_forces(int index, const std::vector<Vec6>& displacements,
                                                 const Vec24& fixed) const {
  const auto i = static_cast<std::size_t>(index);
  std::array<Vec6, 4> result;
  result.fill(Vec6::Zero());
  if (shell_stands[i] == 0) return result;
  // From the first corner's place: a rigid translation of the whole costs no digits. A given stiffness may hold on to
  // the ground.
  Vec24 u = corner_displacements(index, displacements);
  const Vec3 origin = model.shell_stiffness.contains(index) ? Vec3::Zero() : Vec3(u.head<3>());
  for (int n = 0; n < 4; ++n) u.segment<3>(6 * n) -= origin;
  Vec24 force = shell_node_stiffness(index) * u + fixed;
  if (shells_pushed()) force += shell_geometric_stiffness(index) * u;
  for (int n = 0; n < 4; ++n) result[static_cast<std::size_t>(n)] = force.segment<6>(6 * n);
  return result;
}

std::vector<Vec6> FrameElements::patch_forces(int index, const std::vector<Vec6>& displacements) const {
  const std::vector<int>& nodes = model.patches[static_cast<std::size_t>(index)].node;
  Eigen::VectorXd u(static_cast<Eigen::Index>(6 * nodes.size()));
  for (std::size_t n = 0; n < nodes.size(); ++n)
    u.segment<6>(static_cast<Eigen::Index>(6 * n)) = displacements[static_cast<std::size_t>(nodes[n])];
  const Eigen::VectorXd force = patch_node_stiffness(static_cast<std::size_t>(index)) * u;
  std::vector<Vec6> result(nodes.size());
  for (std::size_t n = 0; n < nodes.size(); ++n) result[n] = force.segment<6>(static_cast<Eigen::Index>(6 * n));
  return result;
}

}  // namespace topple::solver
