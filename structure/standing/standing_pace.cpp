// Statics at a pace: what takes long is stopped wherever an allowance of operations ends, and goes on with the next
// one.
//
// Meanwhile nothing that others look at has changed: which parts stand and how they are displaced is settled between
// such pieces of work, never inside of one. Who asks for more (demands, responses) has it run to its end at once; it is
// reckoned with only when it is paid for all the same, so that asking changes nothing that follows.
#include "standing/standing_state.h"

namespace topple::structure {

bool StandingFrame::State::paced(std::function<void()> work, std::function<void()> then) {
  if (!limited()) {
    counted(work);
    if (then) then();
    return true;
  }
  pace.begin(std::move(work));
  after_pace = std::move(then);
  return go_on();
}

/// Looking at a joint or a member takes about as long everywhere.
void StandingFrame::State::spend_on_joints(std::size_t count) {
  constexpr double nanoseconds = 55;
  solver::spend(solver::operations_per_nanosecond * nanoseconds * static_cast<double>(count));
}

/// To find what is left of a panel's elements, and to condense them: together about as long for each.
void StandingFrame::State::spend_on_elements(std::size_t count) {
  constexpr double nanoseconds = 2500;
  solver::spend(solver::operations_per_nanosecond * nanoseconds * static_cast<double>(count));
}

bool StandingFrame::State::go_on() {
  if (pace.done()) return true;
  if (used_up()) return false;
  const double left = limited() ? pace.go_on(allowance) : 0;
  if (limited()) bill(allowance - left);
  if (limited() && !pace.done()) return false;
  finish_paced();
  return true;
}

void StandingFrame::State::finish_paced() {
  bill(pace.finish());
  if (const std::function<void()> then = std::exchange(after_pace, {})) then();
  for (const auto& [key, load] : std::exchange(waiting_loads, {})) load ? set_contact(*load) : remove_contact(key);
}

void StandingFrame::State::set_contact(const ContactLoad& load) {
  if (!pace.done()) {
    waiting_loads.emplace_back(load.key, load);
    return;
  }
  if (!stands(load.place)) return;
  contacts[load.key] = load;
  if (loads.set_contact(load.key, place(load.place, load.force, load.moment))) pending = true;
}

void StandingFrame::State::remove_contact(std::int64_t key) {
  if (!pace.done()) {
    waiting_loads.emplace_back(key, std::nullopt);
    return;
  }
  contacts.erase(key);
  if (loads.remove_contact(key)) pending = true;
}

}  // namespace topple::structure
