// A world once more. Shapes are shared, as nothing changes them; what a step alone needs is not copied.
#include "debris/debris_world.h"

namespace topple::collision {

namespace {

template <class Map>
void copy_each(const Map& from, Map& to) {
  using Held = typename Map::mapped_type::element_type;
  for (const auto& [id, held] : from) to.emplace_hint(to.end(), id, std::make_unique<Held>(*held));
}

}  // namespace

DebrisWorld::DebrisWorld(const DebrisWorld& of)
    : settings_(of.settings_),
      gravity_(of.gravity_),
      moving_obstacles_(of.moving_obstacles_),
      order_(of.order_),
      awake_count_(of.awake_count_),
      next_obstacle_(of.next_obstacle_),
      next_hinge_(of.next_hinge_),
      next_cable_(of.next_cable_),
      ground_(of.ground_),
      has_ground_(of.has_ground_),
      ground_height_(of.ground_height_),
      ground_friction_(of.ground_friction_),
      ground_restitution_(of.ground_restitution_),
      polyhedra_(of.polyhedra_),
      ignored_(of.ignored_),
      released_(of.released_),
      region_(of.region_),
      solver_(settings_, region_),
      slept_now_(of.slept_now_),
      step_number_(of.step_number_),
      parts_(of.parts_),
      reading_(of.reading_),
      contacts_(of.contacts_) {
  for (const auto& one : of.bodies_) bodies_.push_back(one ? std::make_unique<DebrisBody>(*one) : nullptr);
  copy_each(of.obstacles_, obstacles_);
  copy_each(of.hinges_, hinges_);
  copy_each(of.cables_, cables_);
  pairs_.copy(of.pairs_, [&](const Solid& solid) -> Solid* {
    if (solid.kind == Touched::Kind::body) return &body(solid.id);
    return solid.kind == Touched::Kind::obstacle ? static_cast<Solid*>(&obstacle(solid.id)) : &ground_;
  });
}

std::unique_ptr<World> DebrisWorld::copy() const { return std::unique_ptr<World>(new DebrisWorld(*this)); }

}  // namespace topple::collision
