#include "simulation/run_progress.h"

#include <algorithm>

#include "simulation/step_clock.h"

namespace topple::structure {

/// Nobody asks for anything, and nothing is awake.
bool RunProgress::quiet() const {
  return !tools_.asked() && !hosts_.waiting() && !scene_.frame->pending() && scene_.world->awake_count() == 0;
}

bool RunProgress::idle() const {
  if (scene_.step <= 1 || !quiet()) return false;
  const double next = tools_.next_instant();
  return next == unlimited || step_of(next, scene_.scenario.step) > scene_.step;
}

std::int64_t RunProgress::skip_idle_before(std::int64_t end) {
  if (scene_.step < 1 || !quiet()) return 0;
  const double instant = tools_.next_instant();
  const std::int64_t next = instant < unlimited ? std::min(end, step_of(instant, scene_.scenario.step)) : end;
  const std::int64_t passed = std::max<std::int64_t>(0, next - 1 - scene_.step);
  scene_.step += passed;
  return passed;
}

bool RunProgress::rests() const { return scene_.step > 0 && quiet() && tools_.next_instant() == unlimited; }

bool RunProgress::finished() const {
  return scene_.step >= step_of(scene_.scenario.duration, scene_.scenario.step) ||
         (scene_.scenario.until_rest && rests());
}

void RunProgress::record() {
  const bool resting_now = rests();
  if (resting_now && !was_at_rest_) log_.record(SimulationEvent::Kind::at_rest, "");
  was_at_rest_ = resting_now;
  if (done_told_ || !finished()) return;
  done_told_ = true;
  log_.record(SimulationEvent::Kind::done, "");
}

}  // namespace topple::structure
