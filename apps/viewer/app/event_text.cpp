#include "app/event_text.h"

#include <cstdio>

namespace topple::viewer {

std::string event_text(const structure::SimulationEvent& event) {
  using Kind = structure::SimulationEvent::Kind;
  char number[64];
  switch (event.kind) {
    case Kind::tool:
      return event.name;
    case Kind::impact:
      std::snprintf(number, sizeof number, ", %.0f kN", event.peak_force / 1e3);
      return event.body_name + " hits " + event.name + number;
    case Kind::joint_yielded:
      return event.name + " yields";
    case Kind::joint_broke:
      if (event.joint.inside) return event.name + " buckles and breaks in two";
      return event.name + " breaks: " + structure::sense_names[static_cast<std::size_t>(event.joint.sense)];
    case Kind::panel_fractured:
      return event.name + " breaks into chunks";
    case Kind::mechanism:
      return event.name + " moves as a mechanism";
    case Kind::detached:
    case Kind::split:
      std::snprintf(number, sizeof number, "%zu members, %zu panels come off, %.1f t", event.members.size(),
                    event.panels.size(), event.mass / 1e3);
      return number;
    case Kind::at_rest:
      return "at rest";
    case Kind::limited:
      return "bodies removed: the limit is reached";
    case Kind::done:
      return "the scenario ends";
  }
  return event.name;
}

}  // namespace topple::viewer
