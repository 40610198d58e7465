#pragma once
// To and from the scaled equations of a frame system (see its head): with the scale S, what is solved for is S^-1 u,
// and a force f becomes S f.
#include <Eigen/Core>
#include <vector>

#include "assembly/frame_system.h"

namespace topple::solver {

/// The diagonal of S.
[[nodiscard]] inline Eigen::Map<const Eigen::VectorXd> scale_of(const FrameSystem& system) {
  return {system.scale().data(), static_cast<Eigen::Index>(system.dofs().equations)};
}

/// S times the part of a force that acts on the equations; what acts on held freedoms, behind it, is left out. Into a
/// vector that need not grow.
inline void scale_force(const FrameSystem& system, const Eigen::VectorXd& force, Eigen::VectorXd& result) {
  result = force.head(system.dofs().equations).cwiseProduct(scale_of(system));
}
[[nodiscard]] inline Eigen::VectorXd scaled_force(const FrameSystem& system, const Eigen::VectorXd& force) {
  Eigen::VectorXd result;
  scale_force(system, force, result);
  return result;
}

/// The equations' displacements (not forces) from those of nodes; of a diaphragm from its first node that stands.
[[nodiscard]] Eigen::VectorXd scaled_displacements(const FrameSystem& system, const std::vector<Vec6>& per_node);
/// Loads on nodes that make this scaled force on the equations, whatever their numbers are by then; that on a
/// diaphragm acts at its first node that stands.
[[nodiscard]] std::vector<NodeLoad> node_loads_of_scaled(const FrameSystem& system, const Eigen::VectorXd& force);

}  // namespace topple::solver
