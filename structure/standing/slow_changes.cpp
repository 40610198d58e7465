#include "standing/slow_changes.h"

namespace topple::structure {

void SlowChanges::lay() {
  if (!state_.loads.changed() && !softened_) return;
  softened_ = false;
  state_.write_loads();
  for (int c = 0; c < state_.statics.components(); ++c) {
    if (!state_.statics.changed(c)) continue;
    answers_.complete(c);
    // Loads alone make no mechanism in a structure that was stable before.
    if (!answers_.solve_slow(c)) laid(c);
  }
}

/// On the way to rest, what lies on it is part of that way. So is what the structure cannot bear: that state, however
/// far it lies, is never reached.
void SlowChanges::laid(int c) {
  if (!state_.to_check[static_cast<std::size_t>(c)] && answers_.bears(c)) {
    state_.account.finish(c, true, breaks_.lines());
    yielding_.rest(c);
  }
  state_.check_again(c);
}

}  // namespace topple::structure
