#include "assembly/frame_recovery.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "topple/solver/parallel_for.h"

namespace topple::solver {

std::vector<Vec6> node_displacements(const FrameElements& frame, const Eigen::VectorXd& displacement,
                                     const Eigen::VectorXd& held) {
  Eigen::VectorXd all(displacement.size() + held.size());
  all << displacement, held;
  std::vector<Vec6> result(frame.model.nodes.size(), Vec6::Zero());
  for (std::size_t n = 0; n < result.size(); ++n) {
    if (frame.node_stands[n] != 0) result[n] = frame.dofs().node_displacement(static_cast<int>(n), all.data());
  }
  return result;
}

std::vector<Vec6> normalised_shape(const FrameSystem& system, const Eigen::VectorXd& scaled) {
  Eigen::VectorXd u(scaled.size());
  for (Eigen::Index i = 0; i < u.size(); ++i) u(i) = scaled(i) * system.scale()[static_cast<std::size_t>(i)];
  std::vector<Vec6> shape = node_displacements(system, u, Eigen::VectorXd::Zero(system.dofs().held));
  double translation = 0, rotation = 0;
  for (const Vec6& s : shape) {
    translation = std::max(translation, s.head<3>().norm());
    rotation = std::max(rotation, s.tail<3>().norm());
  }
  // Rounding of a motion that only turns nodes is no translation.
  double extent = 0;
  for (const Vec3& node : system.model.nodes) extent = std::max(extent, (node - system.model.nodes.front()).norm());
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

std::vector<StaticSolution> recover_solutions(const FrameSystem& system, std::span<LoadVector> loads,
                                              const Eigen::MatrixXd& displacements, int threads) {
  std::vector<StaticSolution> solutions(loads.size());
  const auto count = static_cast<int>(loads.size());
  parallel_for(count, threads, [&](int set) {
    const auto k = static_cast<std::size_t>(set);
    solutions[k].displacements =
        node_displacements(system, displacements.col(static_cast<Eigen::Index>(k)), loads[k].held_displacement);
    // Each place holds what the loads do at fixed ends until the beam's own turn.
    solutions[k].beam_end_forces = std::move(loads[k].beam_fixed_end);
    solutions[k].beam_end_forces.resize(system.model.beams.size(), Vec12::Zero());
    solutions[k].shell_corner_forces.resize(system.model.shells.size());
  });
  const auto recover_beam = [&](std::size_t i) {
    const Beam& beam = system.model.beams[i];
    std::optional<BeamStrainStiffness> stiffness;
    if (system.second_order == nullptr) stiffness = strain_stiffness(CondensedBeam(beam, system.beam_factor[i]));
    for (StaticSolution& solution : solutions) {
      Vec12& force = solution.beam_end_forces[i];
      const std::vector<Vec6>& u = solution.displacements;
      if (!stiffness) {
        force = system.end_forces(static_cast<int>(i), u, Vec12(force));
        continue;
      }
      const Vec12 rigid_ends = rigid_end_displacements(beam, u[static_cast<std::size_t>(beam.node[0])],
                                                       u[static_cast<std::size_t>(beam.node[1])]);
      force += *stiffness * relative_motion(beam.length, rigid_ends);
    }
  };
  constexpr std::size_t together = 1024;
  const std::size_t beams = system.model.beams.size();
  const int used = count > 1 || system.second_order != nullptr ? threads : 1;  // what one linear set asks for is little
  parallel_for((beams + together - 1) / together, used, [&](std::size_t chunk) {
    const std::size_t first = chunk * together;
    for (std::size_t i = first; i < std::min(beams, first + together); ++i)
      if (system.beam_stands[i] != 0)
        recover_beam(i);
      else
        for (StaticSolution& solution : solutions) solution.beam_end_forces[i].setZero();
  });
  for (std::size_t i = 0; i < system.model.shells.size(); ++i)
    for (std::size_t k = 0; k < loads.size(); ++k) {
      const Vec24 fixed = loads[k].shell_fixed.empty() ? Vec24::Zero() : loads[k].shell_fixed[i];
      solutions[k].shell_corner_forces[i] =
          system.corner_forces(static_cast<int>(i), solutions[k].displacements, fixed);
    }
  parallel_for(count, threads, [&](int set) {
    const auto k = static_cast<std::size_t>(set);
    solutions[k].reactions = support_reactions(system, solutions[k].displacements, solutions[k].beam_end_forces,
                                               solutions[k].shell_corner_forces, loads[k].node_load);
  });
  return solutions;
}

namespace {

/// Held components of a diaphragm's nodes share what the floor needs; where rigid supports of one rigid floor leave the
/// shares undetermined, the least ones (sum of squares) are taken.
void add_diaphragm_reactions(const FrameSystem& system, const std::vector<Vec6>& residual,
                             std::vector<Vec6>& held_reaction) {
  for (std::size_t d = 0; d < system.model.diaphragms.size(); ++d) {
    Vec3 needed = Vec3::Zero();
    std::vector<std::pair<std::size_t, int>> held;
    for (int node : system.model.diaphragms[d].nodes) {
      const auto n = static_cast<std::size_t>(node);
      const Vec6& r = residual[n];
      needed += Vec3(r(0), r(1), r(5) + system.dofs().arm[n][0] * r(1) - system.dofs().arm[n][1] * r(0));
      for (int c : {0, 1, 5}) {
        if (std::isinf(system.support_at(n)(c))) held.emplace_back(n, c);
      }
    }
    if (held.empty()) continue;
    Eigen::MatrixXd statics(3, held.size());
    for (std::size_t k = 0; k < held.size(); ++k) {
      const auto [n, c] = held[k];
      const auto column = static_cast<Eigen::Index>(k);
      if (c == 0) statics.col(column) << 1, 0, -system.dofs().arm[n][1];
      if (c == 1) statics.col(column) << 0, 1, system.dofs().arm[n][0];
      if (c == 5) statics.col(column) << 0, 0, 1;
    }
    const Eigen::VectorXd share = statics.completeOrthogonalDecomposition().solve(needed);
    for (std::size_t k = 0; k < held.size(); ++k) {
      held_reaction[held[k].first](held[k].second) = share(static_cast<Eigen::Index>(k));
    }
  }
}

}  // namespace

std::vector<Vec6> support_reactions(const FrameSystem& system, const std::vector<Vec6>& displacements,
                                    const std::vector<Vec12>& beam_end_forces,
                                    const std::vector<std::array<Vec6, 4>>& shell_corner_forces,
                                    const std::vector<Vec6>& node_loads) {
  std::vector<char> held_node(system.model.nodes.size(), 0);
  for (const Support& support : system.model.supports) held_node[static_cast<std::size_t>(support.node)] = 1;
  for (const Diaphragm& diaphragm : system.model.diaphragms)
    for (const int node : diaphragm.nodes) held_node[static_cast<std::size_t>(node)] = 1;
  const auto reaches_held = [&](const Beam& beam) {
    return held_node[static_cast<std::size_t>(beam.node[0])] != 0 ||
           held_node[static_cast<std::size_t>(beam.node[1])] != 0;
  };
  // What must act on each held node beside its load for equilibrium with its elements.
  std::vector<Vec6> residual(system.model.nodes.size(), Vec6::Zero());
  for (std::size_t i = 0; i < system.model.beams.size(); ++i) {
    if (system.beam_stands[i] == 0 || !reaches_held(system.model.beams[i])) continue;
    const Vec12 force = node_forces(system.model.beams[i], beam_end_forces[i]);
    residual[static_cast<std::size_t>(system.model.beams[i].node[0])] += force.head<6>();
    residual[static_cast<std::size_t>(system.model.beams[i].node[1])] += force.tail<6>();
  }
  for (std::size_t i = 0; i < system.model.shells.size(); ++i) {
    if (system.jointed(static_cast<int>(i)) != nullptr) continue;  // its patch pulls
    for (std::size_t n = 0; n < 4; ++n) {
      residual[static_cast<std::size_t>(system.model.shells[i].node[n])] += shell_corner_forces[i][n];
    }
  }
  for (std::size_t i = 0; i < system.model.patches.size(); ++i) {
    const std::vector<Vec6> forces = system.patch_forces(static_cast<int>(i), displacements);
    for (std::size_t n = 0; n < forces.size(); ++n)
      residual[static_cast<std::size_t>(system.model.patches[i].node[n])] += forces[n];
  }
  for (std::size_t n = 0; n < node_loads.size(); ++n) residual[n] -= node_loads[n];

  std::vector<Vec6> springs(system.model.nodes.size(), Vec6::Zero());
  std::vector<Vec6> result(system.model.supports.size(), Vec6::Zero());
  for (std::size_t i = 0; i < system.model.supports.size(); ++i) {
    const auto n = static_cast<std::size_t>(system.model.supports[i].node);
    for (int c = 0; c < 6; ++c) {
      const double k = system.model.supports[i].stiffness(c);
      if (std::isinf(k) || k == 0) continue;
      result[i](c) = -k * displacements[n](c);
      springs[n](c) += result[i](c);
    }
  }
  for (std::size_t n = 0; n < residual.size(); ++n) residual[n] -= springs[n];
  std::vector<Vec6> held = residual;
  add_diaphragm_reactions(system, residual, held);
  std::vector<Vec6> taken(system.model.nodes.size(), Vec6::Zero());
  for (std::size_t i = 0; i < system.model.supports.size(); ++i) {
    const auto n = static_cast<std::size_t>(system.model.supports[i].node);
    for (int c = 0; c < 6; ++c) {
      if (!std::isinf(system.model.supports[i].stiffness(c)) || taken[n](c) != 0 || system.node_stands[n] == 0)
        continue;
      result[i](c) += held[n](c);
      taken[n](c) = 1;  // two rigid supports on one freedom: the first bears it
    }
  }
  return result;
}

}  // namespace topple::solver
