#include "topple/collision/world.h"

namespace topple::collision {

void World::set_parallel_for(ParallelFor, int) {}

void World::step(double dt, int parts, MovingStructure& structure) {
  step(dt);
  std::vector<Contact> share(contacts().begin(), contacts().end());
  for (Contact& contact : share) {
    contact.impulse /= parts;
    contact.moment /= parts;
  }
  for (int part = 0; part < parts; ++part) structure.advance(dt / parts, share, {});
}

}  // namespace topple::collision
