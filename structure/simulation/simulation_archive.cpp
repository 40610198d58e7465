// The whole state of a simulation, as bytes and back.
#include <cstdint>
#include <utility>

#include "archive/action_archive.h"
#include "archive/event_archive.h"
#include "archive/frame_archive.h"
#include "archive/id_archive.h"
#include "archive/mesh_archive.h"
#include "frame_model_archive.h"
#include "simulation/scene_hash.h"
#include "simulation/simulation_state.h"
#include "state_archive.h"
#include "topple/collision/world_archive.h"
#include "topple/structure/error.h"

namespace topple::structure {

void Simulation::save_state(std::ostream& to) const {
  State& now = *state_;
  StateWriter archive(to);
  archive(scene_hash(now.actions.building_at_start(), now.scene.scenario), now.actions, now.scene);
  now.scene.frame->save_state(to);
  now.scene.world->save_state(to);
  archive(static_cast<StageParts&>(now), *now.moving_parts);
}

void Simulation::load_state(std::istream& from) {
  StateReader archive(from);
  Building start = state_->actions.building_at_start();
  std::uint64_t scene = 0;
  archive(scene);
  if (scene != scene_hash(start, state_->scene.scenario))
    throw InputError("the state is of another scene: its model, its scenario or what was tuned in them differs");
  auto loaded = std::make_unique<State>(std::move(start), state_->scene.scenario, state_->scene.options);
  archive(loaded->actions, loaded->scene);
  loaded->scene.frame->load_state(from);
  loaded->scene.world->load_state(from);
  archive(static_cast<StageParts&>(*loaded), *loaded->moving_parts);
  loaded->log.set_listeners(state_->log.extract_listeners());
  state_ = std::move(loaded);
}

}  // namespace topple::structure
