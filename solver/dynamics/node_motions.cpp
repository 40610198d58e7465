#include "dynamics/node_motions.h"

namespace topple::solver {

NodeMotions::NodeMotions(std::size_t nodes) {
  start_.u.assign(nodes, Vec6::Zero());
  start_.v = end_.u = end_.v = start_.u;
}

bool NodeMotions::evaluate_end(const FrameSystem& system, const MotionState& end) {
  if (end_known_) return false;
  end_known_ = true;
  system.node_displacements_of_scaled(end.u, end_.u);
  return true;
}

void NodeMotions::evaluate(const FrameSystem& system, const MotionState& start, const MotionState& end) {
  if (known_) return;
  known_ = true;
  system.node_displacements_of_scaled(start.u, start_.u);
  system.node_displacements_of_scaled(start.v, start_.v);
  system.node_displacements_of_scaled(end.v, end_.v);
}

void NodeMotions::set_start(const FrameSystem& system, const MotionState& start) {
  known_ = false;
  system.node_displacements_of_scaled(start.u, start_.u);
}

}  // namespace topple::solver
