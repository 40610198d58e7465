#include "simulation/accounts/event_log.h"

namespace topple::structure {

SimulationEvent& EventLog::record(SimulationEvent::Kind kind, const std::string& name) {
  SimulationEvent event;
  event.time = scene_.time();
  event.step = scene_.step;
  event.kind = kind;
  event.name = name;
  events_.push_back(std::move(event));
  return events_.back();
}

void EventLog::record(const JointBreak& broken) {
  const Joint& joint = scene_.building[broken.joint];
  SimulationEvent& event =
      record(SimulationEvent::Kind::joint_broke, broken.inside ? scene_.building[joint.member].name : joint.name);
  event.joint = broken;
  event.position = broken.position;
}

void EventLog::call_listeners() {
  for (; heard_ < events_.size(); ++heard_)
    for (const auto& listener : listeners_) listener(SimulationEvent(events_[heard_]));
}

void EventLog::set_listeners(std::vector<std::function<void(const SimulationEvent&)>> listeners) {
  listeners_ = std::move(listeners);
  heard_ = events_.size();
}

}  // namespace topple::structure
