#include "debris/debris_world.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "bullet/library_check.h"
#include "contacts/contact_order.h"
#include "debris/body_sweep.h"
#include "debris/scene_queries.h"
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

/// Place of a part in the order of contacts: bodies by id before obstacles by id, parts in order of their description.
std::uint64_t order_of(Touched::Kind kind, std::int64_t id, std::size_t part) {
  constexpr std::uint64_t obstacles = std::uint64_t{1} << 62;
  return (kind == Touched::Kind::obstacle ? obstacles : 0) | static_cast<std::uint64_t>(id) << 20 | part;
}

double ball_radius(const std::vector<ConvexPart>& parts) {
  return parts.size() == 1 && parts[0].kind == ConvexPart::Kind::sphere ? parts[0].half_extents.x() : 0;
}

void set_pose(DebrisBody& placed, const Pose& pose) {
  placed.turn = pose.orientation.normalized();
  if (placed.turned) placed.turn = placed.turn * from_bullet(placed.frame.getRotation());
  placed.at = {pose.position, placed.turn.toRotationMatrix()};
}

}  // namespace

DebrisWorld::DebrisWorld(const SolverSettings& settings)
    : scene_(settings),
      ignored_(scene_),
      search_(scene_, ignored_, region_),
      waking_(scene_, search_),
      moving_(scene_),
      solved_(scene_, moving_, region_),
      report_(scene_, solved_, region_),
      rest_(scene_, solved_, report_) {}

/// What a step alone needs is not copied.
DebrisWorld::DebrisWorld(const DebrisWorld& of)
    : next_obstacle_(of.next_obstacle_),
      next_hinge_(of.next_hinge_),
      next_cable_(of.next_cable_),
      polyhedra_(of.polyhedra_),
      scene_(of.scene_),
      ignored_(of.ignored_, scene_),
      region_(of.region_),
      search_(scene_, ignored_, region_),
      waking_(scene_, search_),
      moving_(scene_),
      solved_(scene_, moving_, region_),
      report_(scene_, solved_, region_),
      rest_(scene_, solved_, report_),
      parts_(of.parts_) {
  report_.copy(of.report_);
}

DebrisWorld::~DebrisWorld() = default;

std::unique_ptr<World> DebrisWorld::copy() const { return std::unique_ptr<World>(new DebrisWorld(*this)); }

void DebrisWorld::set_gravity(const Vec3& gravity) {
  scene_.gravity = gravity;
  scene_.wake_all();
}

void DebrisWorld::set_ground(double height, double friction, double restitution) {
  if (!std::isfinite(height)) throw std::invalid_argument("ground: its height is not finite");
  check_surface(friction, restitution, "ground");
  scene_.ground.there = true;
  scene_.ground.height = height;
  scene_.ground.friction = friction;
  scene_.ground.restitution = restitution;
  scene_.pairs.set_ground(&scene_.ground.solid, height);
  scene_.wake_all();
}

BodyId DebrisWorld::add_body(const BodyDescription& description) {
  const BodyId id{std::ssize(scene_.bodies)};
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
  make_shapes(*made);
  made->mass = description.mass;
  made->moments = inertia.moments;
  made->inverse_root_moments = inertia.moments.cwiseSqrt().cwiseInverse();
  made->friction = description.friction;
  made->restitution = description.restitution;
  made->ball_radius = ball_radius(description.parts);
  set_pose(*made, description.pose);
  for (std::size_t i = 0; i < made->parts.size(); ++i)
    made->colliders.push_back(scene_.pairs.add(made.get(), static_cast<int>(i), order_of(made->kind, id.value, i),
                                               DebrisScene::bounds_of(made->shapes[i], made->at)));
  scene_.bodies.push_back(std::move(made));
  scene_.order.push_back(id);
  ++scene_.awake_count;
  set_state(id, {description.pose, description.velocity, description.angular_velocity, false});
  return id;
}

void DebrisWorld::remove_body(BodyId id) {
  DebrisBody& gone = scene_.body(id.value);
  while (!gone.hinges.empty()) remove_hinge({*gone.hinges.begin()});
  while (!gone.cables.empty()) remove_cable({*gone.cables.begin()});
  scene_.wake_touching(gone);
  ignored_.forget(Touched::Kind::body, id.value);
  remove_contacts_of(Touched::Kind::body, id.value);
  for (const std::uint32_t collider : gone.colliders) scene_.pairs.remove(collider);
  if (!gone.asleep) --scene_.awake_count;
  scene_.bodies[static_cast<std::size_t>(id.value)].reset();
  scene_.order.erase(std::lower_bound(scene_.order.begin(), scene_.order.end(), id));
}

ObstacleId DebrisWorld::add_obstacle(const ObstacleDescription& description) {
  const std::string owner = "obstacle " + std::to_string(next_obstacle_);
  check_surface(description.friction, description.restitution, owner);
  auto made = std::make_unique<DebrisObstacle>();
  made->kind = Touched::Kind::obstacle;
  made->id = next_obstacle_;
  made->frame = frame_of_only_box(description.parts).value_or(unturned);
  if (!description.parts.empty()) make_parts(description.parts, owner, polyhedra_, *made);
  make_shapes(*made);
  made->pose = description.pose;
  made->at = made->placement();
  made->friction = description.friction;
  made->restitution = description.restitution;
  for (std::size_t i = 0; i < made->parts.size(); ++i)
    made->colliders.push_back(scene_.pairs.add(made.get(), static_cast<int>(i), order_of(made->kind, made->id, i),
                                               DebrisScene::bounds_of(made->shapes[i], made->at)));
  scene_.obstacles.emplace(next_obstacle_, std::move(made));
  return {next_obstacle_++};
}

void DebrisWorld::remove_obstacle(ObstacleId id) {
  DebrisObstacle& gone = scene_.obstacle(id.value);
  scene_.wake_touching(gone);
  wake_hung_at(gone);
  let_go_of(gone);
  ignored_.forget(Touched::Kind::obstacle, id.value);
  remove_contacts_of(Touched::Kind::obstacle, id.value);
  for (const std::uint32_t collider : gone.colliders) scene_.pairs.remove(collider);
  std::erase(scene_.moving_obstacles, id.value);
  scene_.obstacles.erase(id.value);
}

void DebrisWorld::move_obstacle(ObstacleId id, const Pose& pose) {
  DebrisObstacle& moved = scene_.obstacle(id.value);
  scene_.wake_touching(moved);
  wake_hung_at(moved);
  moved.pose = pose;
  moved.at = moved.placement();
  moved.add_way();
  for (std::size_t i = 0; i < moved.parts.size(); ++i) {
    scene_.pairs.move(moved.colliders[i], DebrisScene::bounds_of(moved.shapes[i], moved.at), 0);
    scene_.pairs.note_way(moved.colliders[i], moved.gone, 0, false);
  }
}

BodyState DebrisWorld::state(BodyId id) const {
  const DebrisBody& seen = scene_.body(id.value);
  BodyState state;
  state.pose.position = seen.at.position;
  state.pose.orientation = seen.turned ? seen.turn * from_bullet(seen.frame.getRotation()).conjugate() : seen.turn;
  state.velocity = stepping_ && !seen.asleep ? Vec3(seen.velocity - scene_.reading) : seen.velocity;
  state.angular_velocity = seen.spin;
  state.asleep = seen.asleep;
  return state;
}

void DebrisWorld::set_state(BodyId id, const BodyState& state) {
  DebrisBody& set = scene_.body(id.value);
  if (!state.pose.position.allFinite() || !state.velocity.allFinite() || !state.angular_velocity.allFinite()) {
    throw std::invalid_argument("body " + std::to_string(id.value) + ": its state is not finite");
  }
  set_pose(set, state.pose);
  set.acceleration = scene_.gravity;
  for (std::size_t i = 0; i < set.parts.size(); ++i)
    scene_.pairs.move(set.colliders[i], DebrisScene::bounds_of(set.shapes[i], set.at), scene_.settings.fat);
  if (!state.asleep) scene_.wake_up(set);
  set.velocity = state.velocity;
  if (!state.asleep) set.velocity += scene_.reading;
  set.spin = state.angular_velocity;
  if (state.asleep) scene_.fall_asleep(set);
}

void DebrisWorld::apply_impulse(BodyId id, const Vec3& impulse, const Vec3& point) {
  DebrisBody& pushed = scene_.body(id.value);
  scene_.wake_up(pushed);
  const Mat3& turn = pushed.at.turn;
  pushed.velocity += impulse / pushed.mass;
  pushed.spin += turn * (turn.transpose() * (point - pushed.at.position).cross(impulse)).cwiseQuotient(pushed.moments);
}

void DebrisWorld::wake(BodyId id) { scene_.wake_up(scene_.body(id.value)); }

/// What goes within a step leaves its contacts to the account of that step.
void DebrisWorld::remove_contacts_of(Touched::Kind kind, std::int64_t id) {
  if (!stepping_) report_.forget(kind, id);
}

void DebrisWorld::ignore_until_separated(BodyId id, const Touched& other) { ignored_.add(id, other); }

std::vector<Contact> DebrisWorld::sweep(double dt, const SweepOptions& options) {
  if (!(dt > 0) || !std::isfinite(dt))
    throw std::invalid_argument("sweep of " + std::to_string(dt) + " s; it must be above zero");
  if (!stepping_) ignored_.release(dt, false);  // what was told to pass does so for a whole step
  std::vector<Contact> found;
  if (options.what == Sweep::obstacles && scene_.obstacles.empty()) return found;
  found = first_touches(scene_, ignored_, dt, options);
  report_.mark_persistent(found);
  std::sort(found.begin(), found.end(), [](const Contact& a, const Contact& b) {
    if (a.time != b.time) return a.time < b.time;
    return before_by_parts(a, b);
  });
  return found;
}

std::optional<RayHit> DebrisWorld::ray_cast(const Vec3& from, const Vec3& to) const {
  return collision::ray_cast(scene_, from, to);
}

std::vector<ObstacleId> DebrisWorld::obstacles_in(const Vec3& low, const Vec3& high) const {
  return collision::obstacles_in(scene_, low, high);
}

std::unique_ptr<World> make_small_steps_world() {
  require_double_precision_library();
  return std::make_unique<DebrisWorld>(solver_settings);
}

std::unique_ptr<World> make_bullet_world() { return make_small_steps_world(); }

}  // namespace topple::collision
