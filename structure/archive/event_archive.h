#pragma once
// What a simulation tells of itself, as bytes (solver/archive/state_archive.h).
#include "archive/frame_archive.h"
#include "topple/collision/world_archive.h"
#include "topple/structure/simulation.h"

namespace topple::structure {

template <class Archive>
void serialize(Archive& archive, SimulationEvent& event) {
  auto& [time, step, kind, name, joint, members, panels, mass, body_name, body, other_body, peak_force, speed_in,
         speed_out, position] = event;
  archive(time, step, kind, name, joint, members, panels, mass, body_name, body, other_body, peak_force, speed_in,
          speed_out, position);
}
template <class Archive>
void serialize(Archive& archive, BodyOverlaps& overlaps) {
  auto& [deep, depth, thickness, time, body, with] = overlaps;
  archive(deep, depth, thickness, time, body, with);
}
template <class Archive>
void serialize(Archive& archive, PieceChanges::Split& split) {
  auto& [from, to] = split;
  archive(from, to);
}
template <class Archive>
void serialize(Archive& archive, PieceChanges& changes) {
  auto& [made, gone, moved, split] = changes;
  archive(made, gone, moved, split);
}
/// What is summed up step by step; energies that are states are measured whenever they are asked for
/// (RunningSums::bring_up_to_date()).
template <class Archive>
void serialize(Archive& archive, Ledger& ledger) {
  auto& [gravity_work, work_put_in, elastic, freed_by_breaks, dissipated_in_joints, kinetic_translation,
         kinetic_rotation, lost_in_impacts, lost_in_contacts, removed, kinetic_standing, damped, lost_in_integration,
         momentum_error] = ledger;
  archive(lost_in_impacts, lost_in_contacts, removed, momentum_error);
}
/// Those that the frame does not count.
template <class Archive>
void serialize(Archive& archive, SimulationCounters& counters) {
  auto& [steps_idle, solves, low_rank, refactorisations, segmentations, collision_steps, contacts_ignored,
         impacts_bounded, impacts_together, selective, background_factors, late_factors] = counters;
  archive(steps_idle, collision_steps, contacts_ignored, impacts_bounded, impacts_together);
}

}  // namespace topple::structure
