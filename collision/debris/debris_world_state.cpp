// The state between two steps as bytes.
#include <stdexcept>

#include "bullet/bullet_archive.h"
#include "debris/debris_world.h"
#include "state_archive.h"

namespace topple::collision {

namespace {
void refuse_within_a_step(bool stepping) {
  if (stepping) throw std::logic_error("a world is saved and loaded between steps, not within one");
}
}  // namespace

void DebrisWorld::save_state(std::ostream& to) const {
  // What follows `ignored` works on the scene or is the host's, and remembers nothing from step to step; but the report
  // is asked for between them.
  const auto& [next_obstacle, next_hinge, next_cable, polyhedra, scene, ignored, region, search, waking, moving, solved,
               report, rest, islands, pushes, parts, stepping] = *this;
  refuse_within_a_step(stepping);
  StateWriter writer(to);
  writer(next_obstacle, next_hinge, next_cable, scene.features(polyhedra));
  scene.save(writer);
  writer(ignored, report);
}

void DebrisWorld::load_state(std::istream& from) {
  refuse_within_a_step(stepping_);
  StateReader reader(from);
  reader(next_obstacle_, next_hinge_, next_cable_, polyhedra_);
  scene_.load(reader, polyhedra_);
  reader(ignored_, report_);
}

}  // namespace topple::collision
