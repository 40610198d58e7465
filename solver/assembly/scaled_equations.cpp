#include "assembly/scaled_equations.h"

#include <stdexcept>
#include <utility>

namespace topple::solver {

Eigen::VectorXd scaled_displacements(const FrameSystem& system, const std::vector<Vec6>& per_node) {
  const DofMap& dofs = system.dofs();
  if (per_node.size() != system.model.nodes.size())
    throw std::invalid_argument("displacements: six for each node of the frame");
  Eigen::VectorXd x = Eigen::VectorXd::Zero(dofs.equations);
  for (std::size_t k = per_node.size(); k-- > 0;) {
    if (system.node_stands[k] == 0) continue;
    Vec6 own = per_node[k];
    own.head<3>() -= dofs.diaphragm_arm(static_cast<int>(k)) * own.tail<3>();
    for (std::size_t c = 0; c < 6; ++c) {
      const int e = dofs.number[k][c];
      if (e < dofs.equations) x(e) = own(static_cast<Eigen::Index>(c)) / system.scale()[static_cast<std::size_t>(e)];
    }
  }
  return x;
}

std::vector<NodeLoad> node_loads_of_scaled(const FrameSystem& system, const Eigen::VectorXd& force) {
  const DofMap& dofs = system.dofs();
  Eigen::VectorXd left = force.cwiseQuotient(scale_of(system));
  std::vector<NodeLoad> loads;
  for (std::size_t k = 0; k < system.model.nodes.size(); ++k) {
    if (system.node_stands[k] == 0) continue;
    NodeLoad load;
    load.node = static_cast<int>(k);
    for (std::size_t c = 0; c < 6; ++c) {
      const int e = dofs.number[k][c];
      if (e < dofs.equations) load.load(static_cast<Eigen::Index>(c)) = std::exchange(left(e), 0);
    }
    load.load.tail<3>() -= dofs.diaphragm_arm(load.node).transpose() * load.load.head<3>();
    if (!load.load.isZero(0)) loads.push_back(load);
  }
  return loads;
}

}  // namespace topple::solver
