// What loses strength and stiffness over time, stage by stage: joints through their capacities, members through their
// moduli. Stages act like events: between them nothing is computed.
#include "model/index_of.h"
#include "simulation/step_clock.h"
#include "simulation/tool_actions.h"

namespace topple::structure {

void ToolActions::use(const WeakenTool& tool) { weakenings_.push_back({tool, used_at_}); }

void ToolActions::use_stages() {
  for (Weakening& weakening : weakenings_)
    while (!weakening.over() && step_of(weakening.next(), scene_.scenario.step) <= scene_.step) use_stage(weakening);
  std::erase_if(weakenings_, [](const Weakening& weakening) { return weakening.over(); });
}

void ToolActions::use_stage(Weakening& weakening) {
  const WeakenTool& tool = weakening.tool;
  log_.record(SimulationEvent::Kind::tool, "weaken");
  const auto change = [&](double last) {
    return weakening.after(weakening.stage + 1, last) / weakening.after(weakening.stage, last);
  };
  const double strength = change(tool.strength), stiffness = change(tool.stiffness);
  ++weakening.stage;
  for (const JointId joint : tool.joints) weaken(joint, strength);
  for (const MemberId member : tool.members) {
    if (stiffness == 1 || !scene_.frame->stands(member)) continue;
    double& factor = stiffness_factors_[index_of(member)];
    factor *= stiffness;
    scene_.frame->set_stiffness_factor(member, factor);
  }
}

/// Multiplies a joint's strength; one that is left with none breaks.
void ToolActions::weaken(JointId joint, double change) {
  if (change == 1 || !scene_.building[joint].capacity.breakable || !scene_.frame->intact(joint)) return;
  if (change > 0) {
    double& factor = scene_.strength_factors[index_of(joint)];
    factor *= change;
    scene_.frame->set_strength_factor(joint, factor);
  } else {
    scene_.frame->break_joint(joint, BreakCause::tool);
  }
}

}  // namespace topple::structure
