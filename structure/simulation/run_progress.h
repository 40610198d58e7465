#pragma once
// How far a run is: whether a step has anything to do, whether all is at rest, whether the run is over.
#include "simulation/accounts/event_log.h"
#include "simulation/host_contacts.h"
#include "simulation/tool_actions.h"

namespace topple::structure {

class RunProgress {
 public:
  /// All must outlive it.
  RunProgress(Scene& scene, EventLog& log, const ToolActions& tools, const HostContacts& hosts)
      : scene_(scene), log_(log), tools_(tools), hosts_(hosts) {}

  /// The step that runs has nothing to do.
  [[nodiscard]] bool idle() const;
  /// Passes over idle steps, at most to the one before `end`. Returns how many.
  std::int64_t skip_idle_before(std::int64_t end);
  [[nodiscard]] bool rests() const;
  [[nodiscard]] bool finished() const;
  /// Tells rest whenever it begins, and the end once.
  void record();

  template <class Archive>
  void serialize(Archive& archive) {
    auto& [scene, log, tools, hosts, was_at_rest, done_told] = *this;
    archive(was_at_rest, done_told);
  }

 private:
  [[nodiscard]] bool quiet() const;

  Scene& scene_;
  EventLog& log_;
  const ToolActions& tools_;
  const HostContacts& hosts_;
  bool was_at_rest_ = false, done_told_ = false;
};

}  // namespace topple::structure
