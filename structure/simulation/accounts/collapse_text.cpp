// The summary of a collapse that a person reads.
#include <cstdarg>
#include <cstdio>
#include <set>

#include "topple/structure/collapse_report.h"

namespace topple::structure {

namespace {

[[gnu::format(printf, 2, 3)]] void append(std::string& text, const char* format, ...) {
  char line[256];
  std::va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(line, sizeof line, format, arguments);
  va_end(arguments);
  text += line;
}

void add_first_breaks(std::string& text, const Simulation& simulation) {
  constexpr int shown = 5;  // enough to see where it began
  constexpr std::array<const char*, 5> causes{"impact", "overload", "buckling", "lost bracing", "a tool"};
  int count = 0;
  for (const SimulationEvent& event : simulation.events()) {
    if (event.kind != SimulationEvent::Kind::joint_broke) continue;
    if (count++ == 0) text += "  first to break:\n";
    if (count > shown) break;
    append(text, "    %8.4f s  %-20s %s (%s, %.4g of %.4g)\n", event.time, event.name.c_str(),
           causes[static_cast<std::size_t>(event.joint.cause)],
           sense_names[static_cast<std::size_t>(event.joint.sense)], event.joint.demand, event.joint.capacity);
  }
}

void add_overlaps(std::string& text, const BodyOverlaps& overlaps) {
  if (overlaps.depth == 0) return;
  append(text, "  inside: %s stayed %.3g m inside %s (the thinner is %.3g m thick), the deepest; told at %.6g s\n",
         overlaps.body.c_str(), overlaps.depth, overlaps.with.c_str(), overlaps.thickness, overlaps.time);
  if (overlaps.deep == 0) return;
  append(text,
         "  warning: %llu times two pieces stayed inside each other by more than %g %% of the thinner one:\n"
         "           what lies on what is right there, how high and how the weight is shared is not\n",
         static_cast<unsigned long long>(overlaps.deep), 100 * collision::OverlapWatch::deep_share);
}

/// Each counts once, in however many senses it did.
std::size_t joints_yielded(const Simulation& simulation) {
  std::set<JointId> joints;
  for (const SimulationEvent& event : simulation.events())
    if (event.kind == SimulationEvent::Kind::joint_yielded) joints.insert(event.joint.joint);
  return joints.size();
}

double fallen_mass(const Simulation& simulation) {
  double mass = 0;
  for (const SimulationEvent& event : simulation.events())
    if (event.kind == SimulationEvent::Kind::detached) mass += event.mass;
  return mass;
}

}  // namespace

std::string collapse_text(const Simulation& simulation, const StepTimes& times) {
  const Building& building = simulation.building();
  const CollapseCounts counts = collapse_counts(simulation);
  const Ledger& ledger = simulation.ledger();
  std::string text;
  append(text, "%s: %.6g s in %lld steps, %s\n",
         simulation.scenario().title.empty() ? "collapse" : simulation.scenario().title.c_str(), simulation.time(),
         static_cast<long long>(simulation.steps()), simulation.at_rest() ? "all at rest" : "still moving");
  append(text, "  broke:  %zu of %zu joints\n", counts.joints_broken, building.joints.size());
  if (const std::size_t yielded = joints_yielded(simulation); yielded > 0)
    append(text, "  yielded: %zu joints, which took up %.4g J\n", yielded, ledger.dissipated_in_joints);
  append(text, "  down:   %zu of %zu members, %zu of %zu panels, %.4g t\n", counts.members_down,
         building.members.size(), counts.panels_down, building.panels.size(), fallen_mass(simulation) / 1000);
  append(text, "  left:   %zu standing segments, %zu bodies\n", counts.standing_segments, counts.bodies);
  add_first_breaks(text, simulation);
  const StepTimes::Percentiles whole = times.whole(), own = times.without_collision_engine();
  append(text, "  steps:  %zu worked, mean %.3g ms, 99 %% under %.3g ms, longest %.3g ms\n", times.steps(), whole.mean,
         whole.p99, whole.max);
  append(text, "          without the collision engine: mean %.3g ms, 99 %% under %.3g ms, longest %.3g ms\n", own.mean,
         own.p99, own.max);
  append(text, "  energy: gravity %.4g J, put in %.4g J; freed by breaks %.4g J, impacts %.4g J, contacts %.4g J\n",
         ledger.gravity_work, ledger.work_put_in, ledger.freed_by_breaks, ledger.lost_in_impacts,
         ledger.lost_in_contacts);
  append(text, "          moving %.4g J, elastic %.4g J, residual %.3g %%\n",
         ledger.kinetic_translation + ledger.kinetic_rotation + ledger.kinetic_standing, ledger.elastic,
         100 * ledger.residual());
  if (simulation.scenario().standing == StandingRule::dynamics)
    append(text, "          damped in what stands %.4g J, lost in integration %.4g J\n", ledger.damped,
           ledger.lost_in_integration);
  add_overlaps(text, simulation.overlaps());
  return text;
}

}  // namespace topple::structure
