// Second order in a collapse that runs: the elastic factor serves, the geometric forces come in as loads.
#include "standing/statics/displaced_rest.h"
#include "standing/statics/frame_statics.h"
#include "topple/solver/geometric_forces.h"

namespace topple::structure {

/// From the answer of the loads with the geometric forces of the last answer. The end forces then hold the displaced
/// member in balance. False when it does not settle: the first-order answer is back.
bool FrameStatics::displace(int number) {
  Component& component = components_[static_cast<std::size_t>(number)];
  const auto geometric = [](const solver::Beam& own, const solver::Vec12& force, const std::vector<Vec6>& at) {
    return solver::geometric_forces(own, force, at[static_cast<std::size_t>(own.node[0])],
                                    at[static_cast<std::size_t>(own.node[1])]);
  };
  const auto answer = [&](const std::vector<Vec6>& before) -> const std::vector<Vec6>* {
    std::vector<Vec6> push(nodes(number).size(), Vec6::Zero());
    for (MemberId member : members(number)) {
      const solver::Vec12& force = end_forces_[index(member)];
      if (force.isZero(0)) continue;
      const solver::Beam& own = beam(member);
      const solver::Vec12 at = solver::node_forces(own, geometric(own, force, before));
      for (std::size_t end = 0; end < 2; ++end)
        push[static_cast<std::size_t>(own.node[end])] -= at.segment<6>(static_cast<Eigen::Index>(6 * end));
    }
    for (std::size_t n = 0; n < push.size(); ++n) {
      geometric_[index(nodes(number)[n])] = push[n];
      write_load(nodes(number)[n]);
    }
    if (!component.analysis->solve().stable) return nullptr;
    read_end_forces(number);
    return &component.analysis->displacements();
  };
  switch (find_displaced_rest(component.analysis->displacements(), answer)) {
    case DisplacedRest::mechanism:
      return true;  // as stable as it was without these loads
    case DisplacedRest::found:
      for (MemberId member : members(number)) {
        solver::Vec12& force = end_forces_[index(member)];
        if (!force.isZero(0)) force += geometric(beam(member), force, component.analysis->displacements());
      }
      return true;
    case DisplacedRest::none:
      break;
  }
  for (NodeId node : nodes(number)) {
    geometric_[index(node)].setZero();
    write_load(node);
  }
  (void)component.analysis->solve();
  read_end_forces(number);
  return false;
}

}  // namespace topple::structure
