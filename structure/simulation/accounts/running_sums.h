#pragma once
// What is summed up over a run: energies, and what was done.
#include "topple/structure/simulation.h"

namespace topple::structure {

struct RunningSums {
  Ledger ledger;
  double body_gravity_work = 0;  ///< J, of gravity on bodies
  double body_work_put_in = 0;   ///< J, by what is launched and by hosts
  double passed_on = 0;          ///< J, of contacts of bodies on what stands and moves
  double kinetic_released = 0;   ///< J that parts of what stands took along as they left
  SimulationCounters counters;

  /// Brings the ledger's entries that are states, not sums, up to date; `translation` and `rotation`: kinetic energies
  /// of the bodies now, J.
  void bring_up_to_date(const FrameEnergy& frame, double translation, double rotation) {
    ledger.elastic = frame.elastic;
    // What left took its motion along: that energy is the bodies' now.
    ledger.freed_by_breaks = frame.freed - kinetic_released;
    ledger.kinetic_standing = frame.kinetic;
    ledger.damped = frame.damped;
    ledger.lost_in_integration = frame.numerical;
    ledger.dissipated_in_joints = frame.dissipated;
    // The loads were laid on slowly before time began, and what lies on the frame goes down with it.
    ledger.gravity_work =
        frame.elastic_at_start + frame.gravity_work + frame.contact_work + body_gravity_work - passed_on;
    ledger.work_put_in = body_work_put_in + frame.other_work;
    ledger.kinetic_translation = translation;
    ledger.kinetic_rotation = rotation;
  }
};

template <class Archive>
void serialize(Archive& archive, RunningSums& sums) {
  auto& [ledger, body_gravity_work, body_work_put_in, passed_on, kinetic_released, counters] = sums;
  archive(ledger, body_gravity_work, body_work_put_in, passed_on, kinetic_released, counters);
}

}  // namespace topple::structure
