#include "standing/damage/queued_changes.h"

namespace topple::structure {

void QueuedChanges::act() {
  for (const Change& change : std::exchange(waiting_, {})) std::visit([&](const auto& one) { act(one); }, change);
}

void QueuedChanges::act(const RemoveSupport& one) {
  if (state_.in_solver.holds(one.node)) state_.account.change(one.node).lose_support(one.node);
  state_.parts.segments.remove_support(one.node);
  state_.statics.remove_support(one.node);
}

void QueuedChanges::act(const EventLoad& one) {
  if (state_.in_solver.holds(one.node)) state_.account.change(one.node).add_load(one.node, one.force);
  state_.loads.add_load(one.node, one.force);
}

void QueuedChanges::act(const Gravity& one) {
  state_.account.turn_gravity();
  state_.loads.set_gravity(one.gravity);
  state_.account.gravity_turned(one.gravity);
}

}  // namespace topple::structure
