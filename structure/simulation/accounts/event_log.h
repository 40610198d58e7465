#pragma once
// What happened, in order: the events of a run, and who listens to them.
#include <functional>
#include <string>
#include <vector>

#include "simulation/scene.h"

namespace topple::structure {

class EventLog {
 public:
  /// `scene` must outlive it.
  explicit EventLog(const Scene& scene) : scene_(scene) {}

  /// A line of this step, to be filled in; good until the next one.
  SimulationEvent& record(SimulationEvent::Kind kind, const std::string& name);
  void record(const JointBreak& broken);

  [[nodiscard]] const std::vector<SimulationEvent>& events() const { return events_; }
  [[nodiscard]] std::size_t size() const { return events_.size(); }
  [[nodiscard]] SimulationEvent& operator[](std::size_t line) { return events_[line]; }

  void listen(std::function<void(const SimulationEvent&)> listener) { listeners_.push_back(std::move(listener)); }
  /// Each listener gets, once, what it has not heard.
  void call_listeners();
  /// Gives the listeners of this log away.
  [[nodiscard]] std::vector<std::function<void(const SimulationEvent&)>> extract_listeners() {
    return std::move(listeners_);
  }
  /// Listeners of another log of the same run, who hear nothing again: neither of what is here already.
  void set_listeners(std::vector<std::function<void(const SimulationEvent&)>> listeners);

  /// Listeners are the host's; set_listeners() tells what they have heard.
  template <class Archive>
  void serialize(Archive& archive) {
    auto& [scene, events, listeners, heard] = *this;
    archive(events);
  }

 private:
  const Scene& scene_;
  std::vector<SimulationEvent> events_;
  std::vector<std::function<void(const SimulationEvent&)>> listeners_;
  std::size_t heard_ = 0;  ///< events that listeners have heard
};

}  // namespace topple::structure
