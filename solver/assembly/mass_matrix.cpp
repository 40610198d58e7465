#include "assembly/mass_matrix.h"

#include <Eigen/Geometry>

#include "assembly/element_masses.h"
#include "topple/solver/parallel_for.h"

namespace topple::solver {

void multiply_symmetric(const SparseSymmetric& A, const Eigen::Ref<const Eigen::MatrixXd>& x, Eigen::MatrixXd& y,
                        int threads) {
  constexpr std::size_t worth_a_thread = 300000;  // entries: fewer are gone through before a thread has started
  const int used = A.value.size() >= worth_a_thread ? threads : 1;
  parallel_for(x.cols(), used, [&](Eigen::Index c) {
    for (int column = 0; column < A.size; ++column) {
      double sum = 0;
      const double at = x(column, c);
      auto k = static_cast<std::size_t>(A.start[static_cast<std::size_t>(column)]);
      const auto end = static_cast<std::size_t>(A.start[static_cast<std::size_t>(column) + 1]);
      sum += A.value[k] * at;
      for (++k; k < end; ++k) {
        sum += A.value[k] * x(A.row[k], c);
        y(A.row[k], c) += A.value[k] * at;
      }
      y(column, c) += sum;
    }
  });
}

MassMatrix::MassMatrix(const FrameSystem& system, const MassModel& masses, int threads)
    : system_(system), threads_(threads), jointed_(masses.jointed), matrix_(system.assembly_map().empty_matrix()) {
  const FrameModel& model = system.model;
  for (std::size_t i = 0; i < model.beams.size(); ++i) {
    if (model.beams[i].density == 0) continue;
    const Mat12 M = beam_mass(system, masses, static_cast<int>(i));
    system.assembly_map().add(i, M.data(), system.scale(), {}, matrix_);
  }
  for (std::size_t i = 0; i < model.shells.size(); ++i)
    if (model.shells[i].density != 0) add_shell(static_cast<int>(i), masses);
  for (std::size_t i = 0; i < model.patches.size(); ++i) {
    if (model.patches[i].mass.size() == 0) continue;
    const Eigen::MatrixXd M = system.patch_mass(i);
    system.assembly_map().add(system.element_of_patch(static_cast<int>(i)), M.data(), system.scale(), {}, matrix_);
  }
  const std::vector<Vec6> at_node = masses_at_nodes(model, masses);
  for (std::size_t n = 0; n < at_node.size(); ++n)
    if (!at_node[n].isZero(0)) add_node(static_cast<int>(n), at_node[n]);
}

void MassMatrix::add_shell(int index, const MassModel& masses) {
  const FrameModel& model = system_.model;
  const Shell& shell = model.shells[static_cast<std::size_t>(index)];
  Mat24 M = shell_mass(system_, masses, index);
  const JointedShell* hung = jointed_shell(jointed_, index);
  if (hung == nullptr) {
    system_.add_diaphragm_arms(shell.node, M);
    system_.assembly_map().add(system_.element_of_shell(index), M.data(), system_.scale(), {}, matrix_);
    return;
  }
  Eigen::MatrixXd all = hung->corners.transpose() * M * hung->corners;
  system_.add_diaphragm_arms(model.patches[static_cast<std::size_t>(hung->patch)].node, all);
  system_.assembly_map().add(system_.element_of_patch(hung->patch), all.data(), system_.scale(), {}, matrix_);
}

void MassMatrix::add_node(int node, const Vec6& diagonal) {
  const DofMap& dofs = system_.dofs();
  const auto n = static_cast<std::size_t>(node);
  Mat6 G = Mat6::Identity();
  G.topRightCorner<3, 3>() = dofs.diaphragm_arm(node);
  const Mat6 M = G.transpose() * diagonal.asDiagonal() * G;
  const auto scale = system_.scale();
  for (std::size_t i = 0; i < 6; ++i)
    for (std::size_t j = 0; j <= i; ++j) {
      const int row = dofs.number[n][i], column = dofs.number[n][j];
      const double entry = M(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
      if (entry == 0 || row >= dofs.equations || column >= dofs.equations) continue;
      matrix_.value[static_cast<std::size_t>(system_.assembly_map().position(row, column))] +=
          entry * scale[static_cast<std::size_t>(row)] * scale[static_cast<std::size_t>(column)];
    }
}

Eigen::MatrixXd MassMatrix::times(const Eigen::Ref<const Eigen::MatrixXd>& x) const {
  Eigen::MatrixXd y = Eigen::MatrixXd::Zero(x.rows(), x.cols());
  multiply_symmetric(matrix_, x, y, threads_);
  return y;
}

Eigen::VectorXd MassMatrix::rigid_motion(int component, const Vec3& centre) const {
  const DofMap& dofs = system_.dofs();
  Eigen::VectorXd motion = Eigen::VectorXd::Zero(dofs.equations);
  const auto set = [&](int equation, double value) {
    if (equation < dofs.equations) motion(equation) = value / system_.scale()[static_cast<std::size_t>(equation)];
  };
  const auto at = [&](const Vec3& place) {
    Vec6 moved = Vec6::Zero();
    moved(component) = 1;
    const Vec3 rotation = moved.tail<3>();
    moved.head<3>() += rotation.cross(place - centre);
    return moved;
  };
  for (std::size_t n = 0; n < system_.model.nodes.size(); ++n) {
    const Vec6 moved = at(system_.model.nodes[n]);
    const bool bound = dofs.diaphragm_of_node[n] >= 0;
    for (int c = 0; c < 6; ++c)
      if (!bound || (c != 0 && c != 1 && c != 5)) set(dofs.number[n][static_cast<std::size_t>(c)], moved(c));
  }
  // A corner that hangs on a held node moves with the whole as far as its joint gives; on others it goes along.
  for (const JointedShell& shell : jointed_) {
    const std::vector<int>& nodes = system_.model.patches[static_cast<std::size_t>(shell.patch)].node;
    for (std::size_t k = 4; k < nodes.size(); ++k)
      for (std::size_t corner = 0; corner < 4; ++corner) {
        const Mat6 axes =
            shell.corners.block<6, 6>(static_cast<Eigen::Index>(6 * corner), static_cast<Eigen::Index>(6 * k));
        if (axes.isZero(0)) continue;
        const auto rigid_end = static_cast<std::size_t>(nodes[corner]);
        Vec6 gap = at(system_.model.nodes[rigid_end]);
        for (int c = 0; c < 6; ++c)
          if (dofs.number[rigid_end][static_cast<std::size_t>(c)] < dofs.equations) gap(c) = 0;
        const Vec6 own = axes.transpose() * gap;
        for (int c = 0; c < 6; ++c)
          set(dofs.number[static_cast<std::size_t>(nodes[k])][static_cast<std::size_t>(c)], own(c));
      }
  }
  for (std::size_t d = 0; d < dofs.diaphragm_number.size(); ++d) {
    const double height = system_.model.nodes[static_cast<std::size_t>(system_.model.diaphragms[d].nodes.front())].z();
    const Vec6 moved = at(Vec3(dofs.diaphragm_reference[d][0], dofs.diaphragm_reference[d][1], height));
    for (std::size_t k = 0; k < 3; ++k) set(dofs.diaphragm_number[d][k], moved(k < 2 ? static_cast<int>(k) : 5));
  }
  return motion;
}

Vec3 MassMatrix::centre() const {
  const auto moment = [&](int rotation, int translation) {
    const Eigen::VectorXd along = rigid_motion(translation, Vec3::Zero()), M = times(along);
    const double total = along.dot(M);
    return total > 0 ? rigid_motion(rotation, Vec3::Zero()).dot(M) / total : 0;
  };
  return {moment(5, 1), moment(3, 2), moment(4, 0)};
}

}  // namespace topple::solver
