#include "standing/motion/moving_law.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace topple::structure {

double MovingLaw::beam_utilisation(int beam, const solver::Vec12& forces) const {
  return std::max(end_utilisation(beam, 0, forces), end_utilisation(beam, 1, forces));
}

double MovingLaw::end_utilisation(int beam, int end, const solver::Vec12& forces) const {
  const JointId joint = from_.building.joint(members_[static_cast<std::size_t>(beam)], end);
  if (!from_.building[joint].capacity.breakable || !from_.parts.standing(joint)) return 0;
  const double use = from_.joints.used(joint, member_joint_demand(forces, end)).value;
  // What is beyond is taken again without the joint that broke.
  if (use <= 1) from_.joints.remember(joint, use);
  if (!std::isfinite(use)) throw std::runtime_error("the motion of " + from_.building[joint].name + " is not finite");
  return use;
}

}  // namespace topple::structure
