#include "standing/motion/moving_law.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace topple::structure {

namespace {
/// A joint without a capacity to speak of is over it by any force. Times of breaks are found between numbers.
constexpr double most = 1e100;
}  // namespace

double MovingLaw::beam_utilisation(int beam, const solver::Vec12& forces) const {
  return std::max(end_utilisation(beam, 0, forces), end_utilisation(beam, 1, forces));
}

double MovingLaw::end_utilisation(int beam, int end, const solver::Vec12& forces) const {
  const JointId joint = from_.building.joint(members_[static_cast<std::size_t>(beam)], end);
  if (!from_.building[joint].capacity.breakable || !from_.parts.standing(joint)) return 0;
  if (!forces.allFinite()) throw std::runtime_error("the motion of " + from_.building[joint].name + " is not finite");
  const double use = std::min(from_.joints.used(joint, member_joint_demand(forces, end)).value, most);
  // What is beyond is taken again without the joint that broke.
  if (use <= 1) from_.joints.remember(joint, use);
  return use;
}

}  // namespace topple::structure
