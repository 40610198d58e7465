#include "standing/damage/break_log.h"

namespace topple::structure {

JointBreak& BreakLog::add(JointId joint, BreakCause cause) {
  const Utilisation used = joints_.check(joint);
  JointBreak broken;
  broken.joint = joint;
  broken.cause = cause;
  broken.sense = used.sense;
  broken.demand = used.demand;
  broken.capacity = used.capacity;
  broken.position = parts_.position(joint);
  return add(broken);
}

JointBreak& BreakLog::add(const JointBreak& line) {
  lines_.push_back(line);
  lines_.back().generation = generation_;
  return lines_.back();
}

}  // namespace topple::structure
