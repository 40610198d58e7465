#include "debris/debris_scene.h"

#include "shapes/find_by_id.h"

namespace topple::collision {

namespace {

template <class Map>
void copy_each(const Map& from, Map& to) {
  using Held = typename Map::mapped_type::element_type;
  for (const auto& [id, held] : from) to.emplace_hint(to.end(), id, std::make_unique<Held>(*held));
}

}  // namespace

DebrisScene::DebrisScene(const DebrisScene& of)
    : settings(of.settings),
      gravity(of.gravity),
      moving_obstacles(of.moving_obstacles),
      order(of.order),
      awake_count(of.awake_count),
      ground(of.ground),
      step_number(of.step_number),
      reading(of.reading) {
  for (const auto& one : of.bodies) bodies.push_back(one ? std::make_unique<DebrisBody>(*one) : nullptr);
  copy_each(of.obstacles, obstacles);
  copy_each(of.hinges, hinges);
  copy_each(of.cables, cables);
  pairs.copy(of.pairs, [this](Touched::Kind kind, std::int64_t id) { return solid(kind, id); });
}

void DebrisScene::make_shapes_again(PolyhedronStore& polyhedra) {
  const auto make = [&](TouchingSolid& of) {
    collision::make_shapes_again(polyhedra, of);
    make_shapes(of);
  };
  for (const auto& one : bodies)
    if (one) make(*one);
  for (const auto& [id, one] : obstacles) make(*one);
}

PolyhedronStore DebrisScene::features(const PolyhedronStore& polyhedra) const {
  PolyhedronStore found;
  for (const auto& one : bodies)
    if (one) take_features(*one, polyhedra, found);
  for (const auto& [id, one] : obstacles) take_features(*one, polyhedra, found);
  return found;
}

DebrisBody& DebrisScene::body(std::int64_t id) const {
  if (id < 0 || id >= std::ssize(bodies) || !bodies[static_cast<std::size_t>(id)]) throw_not_in_the_world(id, "body");
  return *bodies[static_cast<std::size_t>(id)];
}

DebrisObstacle& DebrisScene::obstacle(std::int64_t id) const { return find_by_id(obstacles, id, "obstacle"); }

DebrisHinge& DebrisScene::hinge(std::int64_t id) const { return find_by_id(hinges, id, "hinge"); }

Solid* DebrisScene::solid(Touched::Kind kind, std::int64_t id) {
  if (kind == Touched::Kind::body) return &body(id);
  return kind == Touched::Kind::obstacle ? static_cast<Solid*>(&obstacle(id)) : &ground.solid;
}

DebrisCable& DebrisScene::cable(std::int64_t id) const { return find_by_id(cables, id, "cable"); }

Box3 DebrisScene::bounds_of(const PartShape& shape, const Placement& at) {
  const Vec3 centre = at * shape.centre, half = at.turn.cwiseAbs() * shape.half;
  return {centre - half, centre + half};
}

void DebrisScene::wake_up(DebrisBody& woken) {
  if (woken.asleep) {
    ++awake_count;
    woken.velocity = woken.wakes_with + reading;
    woken.spin = woken.wakes_spinning;
    woken.acceleration = gravity;
  }
  woken.asleep = false;
  woken.slow_for = woken.retry_rest = 0;
  woken.rest_wait = settings.rest_again;
  woken.position_then = woken.at.position;
  woken.turn_then = woken.turn;
}

void DebrisScene::fall_asleep(DebrisBody& sleeping) {
  if (!sleeping.asleep) --awake_count;
  sleeping.asleep = true;
  sleeping.wakes_with = sleeping.velocity;
  sleeping.wakes_spinning = sleeping.spin;
}

void DebrisScene::wake_all() {
  for (const BodyId id : order) wake_up(body(id.value));
}

void DebrisScene::wake_touching(const Solid& solid) {
  for (const std::uint32_t index : pairs.order()) {
    const NearPair& pair = pairs.pair(index);
    Solid *first = pairs.collider(pair.first).solid, *second = pairs.collider(pair.second).solid;
    if (pair.manifold.count == 0 || (first != &solid && second != &solid)) continue;
    for (Solid* one : {first, second})
      if (one->kind == Touched::Kind::body) wake_up(static_cast<DebrisBody&>(*one));
  }
}

/// What hangs together is awake together.
void DebrisScene::wake_hinged() {
  for (bool again = true; again;) {
    again = false;
    for (auto& [id, hinge] : hinges) {
      if (hinge->other < 0) continue;
      DebrisBody &one = body(hinge->body), &other = body(hinge->other);
      if (one.asleep == other.asleep) continue;
      wake_up(one.asleep ? one : other);
      again = true;
    }
  }
}

DebrisObstacle* DebrisScene::moving_holder(const DebrisHinge& hinge) const {
  if (hinge.holder < 0) return nullptr;
  DebrisObstacle& on = obstacle(hinge.holder);
  return on.moves ? &on : nullptr;
}

bool DebrisScene::awake(const NearPair& pair) const {
  return awake(*pairs.collider(pair.first).solid) || awake(*pairs.collider(pair.second).solid);
}

const Placement& DebrisScene::placement(const Solid& solid) {
  static const Placement unplaced;
  return solid.kind == Touched::Kind::ground ? unplaced : static_cast<const TouchingSolid&>(solid).at;
}

}  // namespace topple::collision
