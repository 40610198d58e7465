// What loses strength and stiffness over time, stage by stage: joints through their capacities, members through their
// moduli. Stages act like events: between them nothing is computed.
#include "simulation/simulation_state.h"
#include "simulation/step_clock.h"

namespace topple::structure {

void Simulation::State::use(const WeakenTool& tool) { weakenings.push_back({tool, used_at}); }

void Simulation::State::use_stages() {
  for (Weakening& weakening : weakenings)
    while (!weakening.over() && step_of(weakening.next(), scene.scenario.step) <= scene.step) use_stage(weakening);
  std::erase_if(weakenings, [](const Weakening& weakening) { return weakening.over(); });
}

void Simulation::State::use_stage(Weakening& weakening) {
  const WeakenTool& tool = weakening.tool;
  log.record(SimulationEvent::Kind::tool, "weaken");
  const auto change = [&](double last) {
    return weakening.after(weakening.stage + 1, last) / weakening.after(weakening.stage, last);
  };
  const double strength = change(tool.strength), stiffness = change(tool.stiffness);
  ++weakening.stage;
  for (const JointId joint : tool.joints) weaken(joint, strength);
  for (const MemberId member : tool.members) {
    if (stiffness == 1 || !scene.frame->stands(member)) continue;
    double& factor = stiffness_factors[static_cast<std::size_t>(member.index)];
    factor *= stiffness;
    scene.frame->set_stiffness_factor(member, factor);
  }
}

/// Multiplies a joint's strength; one that is left with none breaks.
void Simulation::State::weaken(JointId joint, double change) {
  if (change == 1 || !scene.building[joint].capacity.breakable || !scene.frame->intact(joint)) return;
  if (change > 0) {
    double& factor = scene.strength_factors[static_cast<std::size_t>(joint.index)];
    factor *= change;
    scene.frame->set_strength_factor(joint, factor);
  } else {
    scene.frame->break_joint(joint, BreakCause::tool);
  }
}

}  // namespace topple::structure
