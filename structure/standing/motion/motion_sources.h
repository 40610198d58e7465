#pragma once
// What the motion of a standing frame is read from: all of it must outlive whatever keeps this.
#include <vector>

#include "failure/joint_states.h"
#include "standing/component_parts.h"
#include "standing/energy/energy_account.h"
#include "standing/panel_superelements.h"
#include "standing/standing_parts.h"
#include "standing/yielding_way.h"

namespace topple::structure {

struct MotionSources {
  const Building& building;
  const StandingParts& parts;
  const FrameLoads& loads;
  FrameStatics& statics;
  JointStates& joints;
  YieldingWay& yielding;
  const ComponentParts& components;
  const PanelSuperelements& shells;
  const EnergyAccount& account;
  const std::vector<char>& node_solved;
  bool second_order = false;
  int threads = 1;
};

}  // namespace topple::structure
