// The state of a standing frame as bytes, and back. Each part says what its own is; here is the order, in which what
// others look at comes first.
#include <istream>
#include <ostream>

#include "archive/frame_archive.h"
#include "frame_model_archive.h"
#include "standing/motion/motion_archive.h"
#include "standing/standing_state.h"
#include "state_archive.h"

namespace topple::structure {

template <class Archive>
void serialize(Archive& archive, TributaryLoads& handed) {
  auto& [beams, nodes, edge_force] = handed;
  archive(beams, edge_force);
  solver::archive_node_loads(archive, nodes);
}

template <class Archive>
void StructuralState::serialize(Archive& archive) {
  auto& [given, of_loads, failure, given_threads, standing_parts, superelements, frame_loads, frame_statics,
         component_parts, joint_states, contents, energy_account, frame_response, contact_loads, in_motion, unchecked] =
      *this;
  // The first four are what the frame was made with.
  archive(standing_parts, superelements, frame_loads, frame_statics, component_parts, joint_states, contents,
          energy_account, frame_response, contact_loads, unchecked);
}

/// `shell_damage` has nothing of its own, `counters` are collected when they are asked for.
template <class Archive>
void StandingFrame::State::serialize(Archive& archive) {
  StructuralState::serialize(archive);
  archive(breaks, yielding, answers, slow, departures, damage, release, generations, queue, pending, slowly, substeps,
          rested_freed, idle_settles);
  bool has_motion = motion != nullptr;
  archive(has_motion);
  MotionSettings settings = motion ? motion->settings() : MotionSettings();
  if (has_motion) archive(settings);
  if constexpr (Archive::is_loading::value) {
    motion.reset();
    statics.before_changes({});
    if (has_motion) make_motion(settings);
  }
  if (has_motion) archive(*motion);
}

void StandingFrame::save_state(std::ostream& to) const {
  StateWriter archive(to);
  archive(*state_);
}

void StandingFrame::load_state(std::istream& from) {
  StateReader archive(from);
  archive(*state_);
}

}  // namespace topple::structure
