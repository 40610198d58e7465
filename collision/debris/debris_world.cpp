#include "debris/debris_world.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "bullet/library_check.h"
#include "shapes/principal_inertia.h"
#include "topple/collision/small_steps.h"

namespace topple::collision {

namespace {

const btTransform unturned = btTransform::getIdentity();

void check_surface(double friction, double restitution, const std::string& owner) {
  if (!(friction >= 0) || !(restitution >= 0) || !(restitution <= 1)) {
    throw std::invalid_argument(owner + ": friction " + std::to_string(friction) + " and restitution " +
                                std::to_string(restitution) +
                                "; accepted are friction from 0 and restitution from 0 to 1");
  }
}

[[noreturn]] void not_in_the_world(std::int64_t id, const char* what) {
  throw std::out_of_range(std::string(what) + " " + std::to_string(id) + " is not in the world");
}

template <typename Map>
auto& find(Map& map, std::int64_t id, const char* what) {
  const auto found = map.find(id);
  if (found == map.end()) not_in_the_world(id, what);
  return *found->second;
}

/// Place of a part in the order of contacts: bodies by id before obstacles by id, parts in order of their description.
std::uint64_t place_in_order(Touched::Kind kind, std::int64_t id, std::size_t part) {
  constexpr std::uint64_t obstacles = std::uint64_t{1} << 62;
  return (kind == Touched::Kind::obstacle ? obstacles : 0) | static_cast<std::uint64_t>(id) << 20 | part;
}

double ball_radius(const std::vector<ConvexPart>& parts) {
  return parts.size() == 1 && parts[0].kind == ConvexPart::Kind::sphere ? parts[0].half_extents.x() : 0;
}

}  // namespace

DebrisWorld::DebrisWorld(const SolverSettings& settings) : settings_(settings), solver_(settings_, region_) {}
DebrisWorld::~DebrisWorld() = default;

DebrisBody& DebrisWorld::body(std::int64_t id) const {
  if (id < 0 || id >= std::ssize(bodies_) || !bodies_[static_cast<std::size_t>(id)]) not_in_the_world(id, "body");
  return *bodies_[static_cast<std::size_t>(id)];
}
DebrisObstacle& DebrisWorld::obstacle(std::int64_t id) const { return find(obstacles_, id, "obstacle"); }
DebrisHinge& DebrisWorld::hinge(std::int64_t id) const { return find(hinges_, id, "hinge"); }
DebrisCable& DebrisWorld::cable(std::int64_t id) const { return find(cables_, id, "cable"); }
const Solid& DebrisWorld::solid(const SolidPair& pair) const {
  if (pair.kind == Touched::Kind::body) return body(pair.other);
  return obstacle(pair.other);
}

void DebrisWorld::set_gravity(const Vec3& gravity) {
  gravity_ = gravity;
  wake_all();
}

void DebrisWorld::set_ground(double height, double friction, double restitution) {
  if (!std::isfinite(height)) throw std::invalid_argument("ground: its height is not finite");
  check_surface(friction, restitution, "ground");
  has_ground_ = true;
  ground_height_ = height;
  ground_friction_ = friction;
  ground_restitution_ = restitution;
  pairs_.set_ground(&ground_, height);
  wake_all();
}

Box3 DebrisWorld::bounds_of(const PartShape& shape, const Placement& at) {
  const Vec3 centre = at * shape.centre, half = at.turn.cwiseAbs() * shape.half;
  return {centre - half, centre + half};
}

void DebrisWorld::place(DebrisBody& placed, const Pose& pose) {
  placed.turn = pose.orientation.normalized();
  if (placed.turned) placed.turn = placed.turn * from_bullet(placed.frame.getRotation());
  placed.at = {pose.position, placed.turn.toRotationMatrix()};
}

BodyId DebrisWorld::add_body(const BodyDescription& description) {
  const BodyId id{std::ssize(bodies_)};
  const std::string owner = "body " + std::to_string(id.value);
  if (!std::isfinite(description.mass) || !(description.mass > 0)) {
    throw std::invalid_argument(owner + ": mass " + std::to_string(description.mass) + "; it must be above zero");
  }
  const PrincipalInertia inertia =
      principal_inertia(description.inertia, frame_of_only_box(description.parts).value_or(unturned), owner);
  check_surface(description.friction, description.restitution, owner);
  auto made = std::make_unique<DebrisBody>();
  made->kind = Touched::Kind::body;
  made->id = id.value;
  made->turned = inertia.turned;
  made->frame = inertia.axes;
  make_parts(description.parts, owner, polyhedra_, *made);
  make_shapes(description.parts, *made);
  made->mass = description.mass;
  made->moments = inertia.moments;
  made->inverse_root_moments = inertia.moments.cwiseSqrt().cwiseInverse();
  made->friction = description.friction;
  made->restitution = description.restitution;
  made->ball_radius = ball_radius(description.parts);
  place(*made, description.pose);
  for (std::size_t i = 0; i < made->parts.size(); ++i)
    made->colliders.push_back(pairs_.add(made.get(), static_cast<int>(i), place_in_order(made->kind, id.value, i),
                                         bounds_of(made->shapes[i], made->at)));
  bodies_.push_back(std::move(made));
  order_.push_back(id);
  ++awake_count_;
  set_state(id, {description.pose, description.velocity, description.angular_velocity, false});
  return id;
}

void DebrisWorld::remove_body(BodyId id) {
  DebrisBody& gone = body(id.value);
  while (!gone.hinges.empty()) remove_hinge({*gone.hinges.begin()});
  while (!gone.cables.empty()) remove_cable({*gone.cables.begin()});
  wake_touching(gone);
  forget_ignored_of(Touched::Kind::body, id.value);
  forget_contacts_of(Touched::Kind::body, id.value);
  for (const std::uint32_t collider : gone.colliders) pairs_.remove(collider);
  if (!gone.asleep) --awake_count_;
  bodies_[static_cast<std::size_t>(id.value)].reset();
  order_.erase(std::lower_bound(order_.begin(), order_.end(), id));
}

ObstacleId DebrisWorld::add_obstacle(const ObstacleDescription& description) {
  const std::string owner = "obstacle " + std::to_string(next_obstacle_);
  check_surface(description.friction, description.restitution, owner);
  auto made = std::make_unique<DebrisObstacle>();
  made->kind = Touched::Kind::obstacle;
  made->id = next_obstacle_;
  made->frame = frame_of_only_box(description.parts).value_or(unturned);
  make_parts(description.parts, owner, polyhedra_, *made);
  make_shapes(description.parts, *made);
  made->pose = description.pose;
  made->at = made->placement();
  made->friction = description.friction;
  made->restitution = description.restitution;
  for (std::size_t i = 0; i < made->parts.size(); ++i)
    made->colliders.push_back(pairs_.add(made.get(), static_cast<int>(i), place_in_order(made->kind, made->id, i),
                                         bounds_of(made->shapes[i], made->at)));
  obstacles_.emplace(next_obstacle_, std::move(made));
  return {next_obstacle_++};
}

void DebrisWorld::remove_obstacle(ObstacleId id) {
  DebrisObstacle& gone = obstacle(id.value);
  wake_touching(gone);
  forget_ignored_of(Touched::Kind::obstacle, id.value);
  forget_contacts_of(Touched::Kind::obstacle, id.value);
  for (const std::uint32_t collider : gone.colliders) pairs_.remove(collider);
  std::erase(moving_obstacles_, id.value);
  obstacles_.erase(id.value);
}

void DebrisWorld::move_obstacle(ObstacleId id, const Pose& pose) {
  DebrisObstacle& moved = obstacle(id.value);
  wake_touching(moved);
  moved.pose = pose;
  moved.at = moved.placement();
  moved.look_how_far();
  for (std::size_t i = 0; i < moved.parts.size(); ++i) {
    pairs_.move(moved.colliders[i], bounds_of(moved.shapes[i], moved.at), 0);
    pairs_.note_way(moved.colliders[i], moved.gone, 0, false);
  }
}

BodyState DebrisWorld::state(BodyId id) const {
  const DebrisBody& seen = body(id.value);
  BodyState state;
  state.pose.position = seen.at.position;
  state.pose.orientation = seen.turned ? seen.turn * from_bullet(seen.frame.getRotation()).conjugate() : seen.turn;
  state.velocity = stepping_ && !seen.asleep ? Vec3(seen.velocity - reading_) : seen.velocity;
  state.angular_velocity = seen.spin;
  state.asleep = seen.asleep;
  return state;
}

void DebrisWorld::set_state(BodyId id, const BodyState& state) {
  DebrisBody& set = body(id.value);
  if (!state.pose.position.allFinite() || !state.velocity.allFinite() || !state.angular_velocity.allFinite()) {
    throw std::invalid_argument("body " + std::to_string(id.value) + ": its state is not finite");
  }
  place(set, state.pose);
  set.velocity = state.velocity;
  if (stepping_ && !set.asleep && !state.asleep) set.velocity += reading_;  // else wake_up() does
  set.spin = state.angular_velocity;
  set.acceleration = gravity_;
  for (std::size_t i = 0; i < set.parts.size(); ++i)
    pairs_.move(set.colliders[i], bounds_of(set.shapes[i], set.at), settings_.fat);
  if (state.asleep)
    fall_asleep(set);
  else
    wake_up(set);
}

void DebrisWorld::apply_impulse(BodyId id, const Vec3& impulse, const Vec3& point) {
  DebrisBody& pushed = body(id.value);
  wake_up(pushed);
  const Mat3& turn = pushed.at.turn;
  pushed.velocity += impulse / pushed.mass;
  pushed.spin += turn * (turn.transpose() * (point - pushed.at.position).cross(impulse)).cwiseQuotient(pushed.moments);
}

void DebrisWorld::wake(BodyId id) { wake_up(body(id.value)); }

void DebrisWorld::wake_up(DebrisBody& woken) {
  if (woken.asleep) {
    ++awake_count_;
    woken.velocity += reading_;
    woken.acceleration = gravity_;
  }
  woken.asleep = false;
  woken.slow_for = woken.retry_rest = 0;
  woken.rest_wait = settings_.rest_again;
  woken.position_then = woken.at.position;
  woken.turn_then = woken.turn;
}

void DebrisWorld::fall_asleep(DebrisBody& sleeping) {
  if (!sleeping.asleep) --awake_count_;
  sleeping.asleep = true;
}

void DebrisWorld::wake_all() {
  for (const BodyId id : order_) wake(id);
}

void DebrisWorld::wake_touching(const Solid& solid) {
  for (const std::uint32_t index : pairs_.order()) {
    const NearPair& pair = pairs_.pair(index);
    Solid *first = pairs_.collider(pair.first).solid, *second = pairs_.collider(pair.second).solid;
    if (pair.manifold.count == 0 || (first != &solid && second != &solid)) continue;
    for (Solid* touching : {first, second})
      if (touching->kind == Touched::Kind::body) wake_up(static_cast<DebrisBody&>(*touching));
  }
}

std::unique_ptr<World> make_small_steps_world() {
  require_double_precision_library();
  return std::make_unique<DebrisWorld>(solver_settings);
}

std::unique_ptr<World> make_bullet_world() { return make_small_steps_world(); }

}  // namespace topple::collision
