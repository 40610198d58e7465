// From the solution of the equations back to nodes, beams and supports.
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "assembly/frame_system.h"
#include "topple/solver/parallel_for.h"

namespace topple::solver {

std::vector<Vec6> FrameSystem::node_displacements(const Eigen::VectorXd& displacement,
                                                  const Eigen::VectorXd& held) const {
  Eigen::VectorXd all(displacement.size() + held.size());
  all << displacement, held;
  std::vector<Vec6> result(model.nodes.size(), Vec6::Zero());
  for (std::size_t n = 0; n < result.size(); ++n) {
    if (node_stands[n] != 0) result[n] = dofs_.node_displacement(static_cast<int>(n), all.data());
  }
  return result;
}

Vec6 FrameSystem::node_displacement_of_scaled(int node, const Eigen::VectorXd& solution) const {
  const auto n = static_cast<std::size_t>(node);
  Vec6 u = Vec6::Zero();
  if (node_stands[n] == 0) return u;
  for (std::size_t c = 0; c < 6; ++c) {
    const int e = dofs_.number[n][c];
    if (e < dofs_.equations) u(static_cast<Eigen::Index>(c)) = solution(e) * scale_[static_cast<std::size_t>(e)];
  }
  u(0) -= dofs_.arm[n][1] * u(5);
  u(1) += dofs_.arm[n][0] * u(5);
  return u;
}

void FrameSystem::node_displacements_of_scaled(const Eigen::VectorXd& solution, std::vector<Vec6>& result) const {
  for (std::size_t n = 0; n < result.size(); ++n)
    result[n] = node_displacement_of_scaled(static_cast<int>(n), solution);
}

std::vector<Vec6> FrameSystem::shape(const Eigen::VectorXd& scaled) const {
  Eigen::VectorXd u(scaled.size());
  for (Eigen::Index i = 0; i < u.size(); ++i) u(i) = scaled(i) * scale_[static_cast<std::size_t>(i)];
  std::vector<Vec6> shape = node_displacements(u, Eigen::VectorXd::Zero(dofs_.held));
  double translation = 0, rotation = 0;
  for (const Vec6& s : shape) {
    translation = std::max(translation, s.head<3>().norm());
    rotation = std::max(rotation, s.tail<3>().norm());
  }
  // Rounding of a motion that only turns nodes is no translation.
  double extent = 0;
  for (const Vec3& node : model.nodes) extent = std::max(extent, (node - model.nodes.front()).norm());
  constexpr double rounding = 1e-9;
  const bool turns_only = translation <= rounding * rotation * extent;
  const double largest = turns_only ? rotation : translation;
  if (!(largest > 0)) return shape;
  constexpr double equal = 1 - 1e-6;
  for (const Vec6& s : shape) {
    const Vec3 part = turns_only ? s.tail<3>() : s.head<3>();
    if (part.norm() < equal * largest) continue;
    Eigen::Index most = 0;
    part.cwiseAbs().maxCoeff(&most);
    const double sign = part(most) < 0 ? -1 : 1;
    for (Vec6& all : shape) all *= sign / largest;
    break;
  }
  return shape;
}

Vec12 FrameSystem::end_forces(int index, const std::vector<Vec6>& displacements, const Vec12& fixed_end) const {
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

std::vector<StaticSolution> FrameSystem::recover(std::span<LoadVector> loads, const Eigen::MatrixXd& displacements,
                                                 int threads) const {
  std::vector<StaticSolution> solutions(loads.size());
  const auto count = static_cast<int>(loads.size());
  parallel_for(count, threads, [&](int set) {
    const auto k = static_cast<std::size_t>(set);
    solutions[k].displacements =
        node_displacements(displacements.col(static_cast<Eigen::Index>(k)), loads[k].held_displacement);
    // Each place holds what the loads do at fixed ends until the beam's own turn.
    solutions[k].beam_end_forces = std::move(loads[k].beam_fixed_end);
    solutions[k].beam_end_forces.resize(model.beams.size(), Vec12::Zero());
    solutions[k].shell_corner_forces.resize(model.shells.size());
  });
  const auto recover_beam = [&](std::size_t i) {
    const Beam& beam = model.beams[i];
    std::optional<BeamStrainStiffness> stiffness;
    if (second_order == nullptr) stiffness = strain_stiffness(CondensedBeam(beam, beam_factor[i]));
    for (StaticSolution& solution : solutions) {
      Vec12& force = solution.beam_end_forces[i];
      const std::vector<Vec6>& u = solution.displacements;
      if (!stiffness) {
        force = end_forces(static_cast<int>(i), u, Vec12(force));
        continue;
      }
      const Vec12 rigid_ends = rigid_end_displacements(beam, u[static_cast<std::size_t>(beam.node[0])],
                                                       u[static_cast<std::size_t>(beam.node[1])]);
      force += *stiffness * relative_motion(beam.length, rigid_ends);
    }
  };
  constexpr std::size_t together = 1024;
  const std::size_t beams = model.beams.size();
  const int used = count > 1 || second_order != nullptr ? threads : 1;  // what one linear set asks for is little
  parallel_for((beams + together - 1) / together, used, [&](std::size_t chunk) {
    const std::size_t first = chunk * together;
    for (std::size_t i = first; i < std::min(beams, first + together); ++i)
      if (beam_stands[i] != 0)
        recover_beam(i);
      else
        for (StaticSolution& solution : solutions) solution.beam_end_forces[i].setZero();
  });
  for (std::size_t i = 0; i < model.shells.size(); ++i)
    for (std::size_t k = 0; k < loads.size(); ++k) {
      const Vec24 fixed = loads[k].shell_fixed.empty() ? Vec24::Zero() : loads[k].shell_fixed[i];
      solutions[k].shell_corner_forces[i] = corner_forces(static_cast<int>(i), solutions[k].displacements, fixed);
    }
  parallel_for(count, threads, [&](int set) {
    const auto k = static_cast<std::size_t>(set);
    solutions[k].reactions = reactions(solutions[k].displacements, solutions[k].beam_end_forces,
                                       solutions[k].shell_corner_forces, loads[k].node_load);
  });
  return solutions;
}

std::array<Vec6, 4> FrameSystem::corner_forces(int index, const std::vector<Vec6>& displacements,
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

std::vector<Vec6> FrameSystem::patch_forces(int index, const std::vector<Vec6>& displacements) const {
  const std::vector<int>& nodes = model.patches[static_cast<std::size_t>(index)].node;
  Eigen::VectorXd u(static_cast<Eigen::Index>(6 * nodes.size()));
  for (std::size_t n = 0; n < nodes.size(); ++n)
    u.segment<6>(static_cast<Eigen::Index>(6 * n)) = displacements[static_cast<std::size_t>(nodes[n])];
  const Eigen::VectorXd force = patch_node_stiffness(static_cast<std::size_t>(index)) * u;
  std::vector<Vec6> result(nodes.size());
  for (std::size_t n = 0; n < nodes.size(); ++n) result[n] = force.segment<6>(static_cast<Eigen::Index>(6 * n));
  return result;
}

/// Held components of a diaphragm's nodes share what the floor needs; where rigid supports of one rigid floor leave the
/// shares undetermined, the least ones (sum of squares) are taken.
void FrameSystem::add_diaphragm_reactions(const std::vector<Vec6>& residual, std::vector<Vec6>& held_reaction) const {
  for (std::size_t d = 0; d < model.diaphragms.size(); ++d) {
    Vec3 needed = Vec3::Zero();
    std::vector<std::pair<std::size_t, int>> held;
    for (int node : model.diaphragms[d].nodes) {
      const auto n = static_cast<std::size_t>(node);
      const Vec6& r = residual[n];
      needed += Vec3(r(0), r(1), r(5) + dofs_.arm[n][0] * r(1) - dofs_.arm[n][1] * r(0));
      for (int c : {0, 1, 5}) {
        if (std::isinf(support_[n](c))) held.emplace_back(n, c);
      }
    }
    if (held.empty()) continue;
    Eigen::MatrixXd statics(3, held.size());
    for (std::size_t k = 0; k < held.size(); ++k) {
      const auto [n, c] = held[k];
      const auto column = static_cast<Eigen::Index>(k);
      if (c == 0) statics.col(column) << 1, 0, -dofs_.arm[n][1];
      if (c == 1) statics.col(column) << 0, 1, dofs_.arm[n][0];
      if (c == 5) statics.col(column) << 0, 0, 1;
    }
    const Eigen::VectorXd share = statics.completeOrthogonalDecomposition().solve(needed);
    for (std::size_t k = 0; k < held.size(); ++k) {
      held_reaction[held[k].first](held[k].second) = share(static_cast<Eigen::Index>(k));
    }
  }
}

std::vector<Vec6> FrameSystem::reactions(const std::vector<Vec6>& displacements,
                                         const std::vector<Vec12>& beam_end_forces,
                                         const std::vector<std::array<Vec6, 4>>& shell_corner_forces,
                                         const std::vector<Vec6>& node_loads) const {
  std::vector<char> held_node(model.nodes.size(), 0);
  for (const Support& support : model.supports) held_node[static_cast<std::size_t>(support.node)] = 1;
  for (const Diaphragm& diaphragm : model.diaphragms)
    for (const int node : diaphragm.nodes) held_node[static_cast<std::size_t>(node)] = 1;
  const auto reaches_held = [&](const Beam& beam) {
    return held_node[static_cast<std::size_t>(beam.node[0])] != 0 ||
           held_node[static_cast<std::size_t>(beam.node[1])] != 0;
  };
  // What must act on each held node beside its load for equilibrium with its elements.
  std::vector<Vec6> residual(model.nodes.size(), Vec6::Zero());
  for (std::size_t i = 0; i < model.beams.size(); ++i) {
    if (beam_stands[i] == 0 || !reaches_held(model.beams[i])) continue;
    const Vec12 force = node_forces(model.beams[i], beam_end_forces[i]);
    residual[static_cast<std::size_t>(model.beams[i].node[0])] += force.head<6>();
    residual[static_cast<std::size_t>(model.beams[i].node[1])] += force.tail<6>();
  }
  for (std::size_t i = 0; i < model.shells.size(); ++i) {
    if (jointed(static_cast<int>(i)) != nullptr) continue;  // its patch pulls
    for (std::size_t n = 0; n < 4; ++n) {
      residual[static_cast<std::size_t>(model.shells[i].node[n])] += shell_corner_forces[i][n];
    }
  }
  for (std::size_t i = 0; i < model.patches.size(); ++i) {
    const std::vector<Vec6> forces = patch_forces(static_cast<int>(i), displacements);
    for (std::size_t n = 0; n < forces.size(); ++n)
      residual[static_cast<std::size_t>(model.patches[i].node[n])] += forces[n];
  }
  for (std::size_t n = 0; n < node_loads.size(); ++n) residual[n] -= node_loads[n];

  std::vector<Vec6> springs(model.nodes.size(), Vec6::Zero());
  std::vector<Vec6> result(model.supports.size(), Vec6::Zero());
  for (std::size_t i = 0; i < model.supports.size(); ++i) {
    const auto n = static_cast<std::size_t>(model.supports[i].node);
    for (int c = 0; c < 6; ++c) {
      const double k = model.supports[i].stiffness(c);
      if (std::isinf(k) || k == 0) continue;
      result[i](c) = -k * displacements[n](c);
      springs[n](c) += result[i](c);
    }
  }
  for (std::size_t n = 0; n < residual.size(); ++n) residual[n] -= springs[n];
  std::vector<Vec6> held = residual;
  add_diaphragm_reactions(residual, held);
  std::vector<Vec6> taken(model.nodes.size(), Vec6::Zero());
  for (std::size_t i = 0; i < model.supports.size(); ++i) {
    const auto n = static_cast<std::size_t>(model.supports[i].node);
    for (int c = 0; c < 6; ++c) {
      if (!std::isinf(model.supports[i].stiffness(c)) || taken[n](c) != 0 || node_stands[n] == 0) continue;
      result[i](c) += held[n](c);
      taken[n](c) = 1;  // two rigid supports on one freedom: the first bears it
    }
  }
  return result;
}

}  // namespace topple::solver
