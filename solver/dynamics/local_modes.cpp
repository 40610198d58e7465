// How some nodes of a frame that moves answer while all others are held.
#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <numeric>
#include <stdexcept>

#include "assembly/checked_index.h"
#include "dynamics/dynamic_state.h"

namespace topple::solver {
namespace {

/// Of the largest: squared frequencies below it are those of motions without strain.
constexpr double no_strain = 1e-12;

/// Rows and columns of a symmetric matrix, ascending.
Eigen::MatrixXd part_of(const SparseSymmetric& matrix, const std::vector<int>& equations) {
  const auto n = static_cast<Eigen::Index>(equations.size());
  Eigen::MatrixXd part = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index j = 0; j < n; ++j) {
    const auto column = static_cast<std::size_t>(equations[static_cast<std::size_t>(j)]);
    auto k = static_cast<std::size_t>(matrix.start[column]);
    const auto end = static_cast<std::size_t>(matrix.start[column + 1]);
    for (Eigen::Index i = j; i < n && k < end; ++i) {
      const int row = equations[static_cast<std::size_t>(i)];
      while (k < end && matrix.row[k] < row) ++k;
      if (k < end && matrix.row[k] == row) part(i, j) = part(j, i) = matrix.value[k];
    }
  }
  return part;
}

/// Equations of the nodes that stand, ascending.
std::vector<int> equations_of(const FrameSystem& system, std::span<const int> nodes) {
  std::vector<int> found;
  for (const int node : nodes) {
    if (system.node_stands[checked_node(system.model, node)] == 0) continue;
    for (const int e : system.dofs().number[static_cast<std::size_t>(node)])
      if (e < system.dofs().equations) found.push_back(e);
  }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

/// Of the beams that stand at these nodes, in each of the motions that `motions` has by column for these equations.
std::vector<std::pair<int, Eigen::Matrix<double, 12, Eigen::Dynamic>>> end_forces_of(const FrameSystem& system,
                                                                                     std::span<const int> nodes,
                                                                                     const std::vector<int>& equations,
                                                                                     const Eigen::MatrixXd& motions) {
  std::vector<int> beams;
  for (const int node : nodes)
    for (const int beam : system.beams_of_node(node))
      if (system.beam_stands[static_cast<std::size_t>(beam)] != 0) beams.push_back(beam);
  std::sort(beams.begin(), beams.end());
  beams.erase(std::unique(beams.begin(), beams.end()), beams.end());
  std::vector<std::pair<int, Eigen::Matrix<double, 12, Eigen::Dynamic>>> all;
  for (const int beam : beams)
    all.emplace_back(beam, Eigen::Matrix<double, 12, Eigen::Dynamic>::Zero(12, motions.cols()));
  Eigen::VectorXd moved = Eigen::VectorXd::Zero(system.dofs().equations);
  std::vector<Vec6> by_node(system.model.nodes.size(), Vec6::Zero());
  for (Eigen::Index mode = 0; mode < motions.cols(); ++mode) {
    for (std::size_t i = 0; i < equations.size(); ++i)
      moved(equations[i]) = motions(static_cast<Eigen::Index>(i), mode);
    for (const auto& [beam, forces] : all)
      for (const int node : system.model.beams[static_cast<std::size_t>(beam)].node)
        by_node[static_cast<std::size_t>(node)] = system.node_displacement_of_scaled(node, moved);
    for (auto& [beam, forces] : all) forces.col(mode) = system.end_forces(beam, by_node, Vec12::Zero());
  }
  return all;
}

}  // namespace

LocalModes FrameDynamics::local_modes(std::span<const int> nodes, std::span<const std::vector<Impulse>> pushes) const {
  const State& state = *state_;
  const FrameSystem& system = state.system();
  LocalModes local;
  const SparseSymmetric& mass = system.mass();
  const std::vector<int> sorted = equations_of(system, nodes);
  const auto has_mass = [&](int place) {
    const auto e = static_cast<std::size_t>(sorted[static_cast<std::size_t>(place)]);
    return mass.value[static_cast<std::size_t>(mass.start[e])] > 0;
  };
  std::vector<int> order(sorted.size());  // those with mass first
  std::iota(order.begin(), order.end(), 0);
  const auto first_bare = std::stable_partition(order.begin(), order.end(), has_mass);
  const Eigen::Index n = first_bare - order.begin(), bare = order.end() - first_bare;
  std::vector<int> all;
  for (const int place : order) all.push_back(sorted[static_cast<std::size_t>(place)]);
  local.equations.assign(all.begin(), all.begin() + n);
  const Eigen::MatrixXd inert = part_of(mass, sorted);
  const Eigen::MatrixXd stiff = part_of(system.matrix(), sorted) - system.inertia->factor * inert;
  const Eigen::MatrixXd K = stiff(order, order), M = inert(order, order);
  Eigen::MatrixXd follow = Eigen::MatrixXd::Identity(n + bare, n);  // what has no mass follows what has
  if (bare > 0)
    follow.bottomRows(bare) =
        -K.bottomRightCorner(bare, bare).completeOrthogonalDecomposition().solve(K.bottomLeftCorner(bare, n));
  if (n == 0) {
    local.pushed.resize(0, static_cast<Eigen::Index>(pushes.size()));
    return local;
  }
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> modes(follow.transpose() * K * follow,
                                                                        M.topLeftCorner(n, n));
  if (modes.info() != Eigen::Success) throw std::runtime_error("local modes of a frame were not found");
  local.squared = modes.eigenvalues();
  const double least = no_strain * local.squared.cwiseAbs().maxCoeff();
  for (double& one : local.squared)
    if (one < least) one = 0;
  local.shape = modes.eigenvectors();
  local.momentum = M.topLeftCorner(n, n) * local.shape;

  local.pushed.resize(n, static_cast<Eigen::Index>(pushes.size()));
  const Eigen::MatrixXd whole = follow * local.shape;
  for (std::size_t k = 0; k < pushes.size(); ++k) {
    const Eigen::VectorXd force = state.scaled_impulses(pushes[k]);
    local.pushed.col(static_cast<Eigen::Index>(k)) = whole.transpose() * force(all);
  }
  local.end_forces = end_forces_of(system, nodes, all, whole);
  return local;
}

Eigen::VectorXd carried_over(const LocalModes& from, const Eigen::VectorXd& coordinates, const LocalModes& to) {
  const Eigen::VectorXd motion = from.shape * coordinates;
  Eigen::VectorXd kept = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(to.equations.size()));
  for (std::size_t i = 0; i < to.equations.size(); ++i) {
    const auto same = std::lower_bound(from.equations.begin(), from.equations.end(), to.equations[i]);
    if (same != from.equations.end() && *same == to.equations[i])
      kept(static_cast<Eigen::Index>(i)) = motion(same - from.equations.begin());
  }
  return to.momentum.transpose() * kept;
}

}  // namespace topple::solver
