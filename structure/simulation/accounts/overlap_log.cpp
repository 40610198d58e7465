#include "simulation/accounts/overlap_log.h"

namespace topple::structure {

void OverlapLog::read() {
  watch_.read(scene_.world->contacts(), scene_.scenario.step);
  told_.deep = watch_.deep_count();
  const std::optional<collision::Overlap>& deepest = watch_.deepest();
  if (!deepest || deepest->depth == told_.depth) return;
  told_.depth = deepest->depth;
  told_.thickness = deepest->thickness;
  told_.time = static_cast<double>(scene_.step) * scene_.scenario.step;
  told_.body = debris_.name(deepest->body, deepest->part_tag);
  switch (deepest->other.kind) {
    case collision::Touched::Kind::ground:
      told_.with = "ground";
      break;
    case collision::Touched::Kind::obstacle: {
      const Part part = debris_.obstacles.part_of(deepest->other.obstacle);
      told_.with = part.valid() ? part_name(scene_.building, part) : std::string();
      break;
    }
    case collision::Touched::Kind::body:
      told_.with = debris_.name(deepest->other.body, deepest->other.part_tag);
      break;
  }
}

}  // namespace topple::structure
