#include "topple/collision/world.h"

#include <stdexcept>

namespace topple::collision {

void World::save_state(std::ostream&) const { throw std::logic_error("this engine cannot save its state"); }

void World::load_state(std::istream&) { throw std::logic_error("this engine cannot load a state"); }

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
