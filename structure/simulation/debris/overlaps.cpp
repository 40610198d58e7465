// What stays inside each other is told by name, when it is seen: bodies split and go.
#include "simulation/simulation_state.h"

namespace topple::structure {

void Simulation::State::watch_overlaps() {
  overlap_watch.read(scene.world->contacts(), scene.scenario.step);
  overlaps.deep = overlap_watch.deep_count();
  const std::optional<collision::Overlap>& deepest = overlap_watch.deepest();
  if (!deepest || deepest->depth == overlaps.depth) return;
  overlaps.depth = deepest->depth;
  overlaps.thickness = deepest->thickness;
  overlaps.time = static_cast<double>(scene.step) * scene.scenario.step;
  overlaps.body = debris.name(deepest->body, deepest->part_tag);
  switch (deepest->other.kind) {
    case collision::Touched::Kind::ground:
      overlaps.with = "ground";
      break;
    case collision::Touched::Kind::obstacle: {
      const Part part = debris.obstacles.part_of(deepest->other.obstacle);
      overlaps.with = part.valid() ? part_name(scene.building, part) : std::string();
      break;
    }
    case collision::Touched::Kind::body:
      overlaps.with = debris.name(deepest->other.body, deepest->other.part_tag);
      break;
  }
}

const BodyOverlaps& Simulation::overlaps() const { return state_->overlaps; }

}  // namespace topple::structure
