#include "bullet/bullet_world.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "bullet/library_check.h"
#include "shapes/find_by_id.h"
#include "shapes/principal_inertia.h"
#include "topple/collision/sequential_impulse.h"

namespace topple::collision {

namespace {

/// Named tunables of the solver, with what they do.
struct Settings {
  int iterations = 50;        ///< of sequential impulse where contacts and joints load what stands
  int loose_iterations = 20;  ///< where a heap lies on the ground alone
  double warm_start =
      0.95;  ///< share of the last step's impulses to begin with: with less heaps creep, with all a wedged piece rocks
  double slop =
      0.002;  ///< m by which contacts may overlap unpushed: pushed apart fully, a heap creeps for twenty seconds
  double restitution_from =
      0.5;  ///< m/s: slower contacts do not bounce, so that piles come to rest (2 g dt at 1/60 s is 0.33)
  double asleep_below =
      0.1;  ///< m/s and rad/s for two seconds. Bullet's 0.8 and 1 freeze a post that has begun to topple
  double rolling_resistance =
      0.1;  ///< of the normal force times the radius, a ball on soil: on flat ground it would roll for ever
  double continuous_from = 0.5;  ///< of a ball's radius: motion in one step above which the step itself looks for
                                 ///< tunnelling. Pieces are left out: what stands is swept before, the ground is a half
                                 ///< space, and what flies through other pieces harms none
};
constexpr Settings kSettings;

constexpr int kBodies = btBroadphaseProxy::DefaultFilter;
constexpr int kStanding = btBroadphaseProxy::StaticFilter;

/// Bullet multiplies the coefficients of a pair: square roots make it the geometric mean.
void set_surface(btCollisionObject& object, double friction, double restitution, const std::string& owner) {
  if (!(friction >= 0) || !(restitution >= 0) || !(restitution <= 1)) {
    throw std::invalid_argument(owner + ": friction " + std::to_string(friction) + " and restitution " +
                                std::to_string(restitution) +
                                "; accepted are friction from 0 and restitution from 0 to 1");
  }
  object.setFriction(std::sqrt(friction));
  object.setRestitution(std::sqrt(restitution));
}

const btTransform unturned = btTransform::getIdentity();

/// Of a body that is one ball; 0 for any other.
double ball_radius(const std::vector<ConvexPart>& parts) {
  return parts.size() == 1 && parts[0].kind == ConvexPart::Kind::sphere ? parts[0].half_extents.x() : 0;
}

btDefaultCollisionConstructionInfo room_for_own_algorithms() {
  btDefaultCollisionConstructionInfo info;
  info.m_customCollisionAlgorithmMaxElementSize = size_of_polyhedron_contacts();
  return info;
}

Body& body_of(btRigidBody& rigid) { return *static_cast<Body*>(static_cast<Solid*>(rigid.getUserPointer())); }

}  // namespace

BulletWorld::BulletWorld()
    : configuration_(room_for_own_algorithms()),
      dispatcher_(&configuration_),
      solver_(kSettings.iterations, kSettings.loose_iterations),
      world_(&dispatcher_, &broadphase_, &solver_, &configuration_) {
  dispatcher_.setDispatcherFlags(dispatcher_.getDispatcherFlags() &
                                 ~btCollisionDispatcher::CD_USE_RELATIVE_CONTACT_BREAKING_THRESHOLD);
  use_half_space_contacts(dispatcher_, polyhedron_first_, plane_first_);
  use_polyhedron_contacts(dispatcher_, polyhedra_contacts_);
  world_.record_with([](btRigidBody& rigid) -> SolverVelocities& { return body_of(rigid).velocities; });
  world_.setGravity({0, 0, 0});  // not the one that Bullet begins with
  world_.setForceUpdateAllAabbs(false);
  world_.getDispatchInfo().m_deterministicOverlappingPairs = true;  // manifolds of an island, too, are put in order
  btContactSolverInfo& info = world_.getSolverInfo();
  info.m_warmstartingFactor = kSettings.warm_start;
  info.m_linearSlop = kSettings.slop;
  info.m_solverMode |= SOLVER_USE_2_FRICTION_DIRECTIONS;
  info.m_restitutionVelocityThreshold = kSettings.restitution_from;
  // Overlaps are pushed apart by displacements alone, at every depth: they must not turn into kinetic energy.
  info.m_splitImpulse = true;
  info.m_splitImpulsePenetrationThreshold = BT_LARGE_FLOAT;
}

BulletWorld::~BulletWorld() {
  for (auto& [id, hinge] : hinges_) world_.removeConstraint(hinge->constraint.get());
  for (auto& [id, cable] : cables_) world_.removeConstraint(&cable->constraint);
  for (const BodyId id : order_) world_.removeRigidBody(body(id.value).rigid.get());
  for (auto& [id, obstacle] : obstacles_)
    if (obstacle->fixed) world_.removeCollisionObject(obstacle->fixed.get());
  remove_ground();
}

Body& BulletWorld::body(std::int64_t id) {
  if (id < 0 || id >= std::ssize(bodies_) || !bodies_[static_cast<std::size_t>(id)]) throw_not_in_the_world(id, "body");
  return *bodies_[static_cast<std::size_t>(id)];
}
const Body& BulletWorld::body(std::int64_t id) const { return const_cast<BulletWorld*>(this)->body(id); }
Obstacle& BulletWorld::obstacle(std::int64_t id) { return find_by_id(obstacles_, id, "obstacle"); }
Hinge& BulletWorld::hinge(std::int64_t id) { return find_by_id(hinges_, id, "hinge"); }
const Hinge& BulletWorld::hinge(std::int64_t id) const { return find_by_id(hinges_, id, "hinge"); }

void BulletWorld::set_gravity(const Vec3& gravity) {
  wake_all();  // Bullet gives a new gravity to active bodies only
  world_.setGravity(to_bullet(gravity));
}

void BulletWorld::remove_ground() {
  if (!ground_object_) return;
  world_.removeCollisionObject(ground_object_.get());
  ground_object_.reset();
}

void BulletWorld::set_ground(double height, double friction, double restitution) {
  if (!std::isfinite(height)) throw std::invalid_argument("ground: its height is not finite");
  auto object = std::make_unique<btCollisionObject>();
  set_surface(*object, friction, restitution, "ground");
  remove_ground();
  ground_height_ = height;
  ground_shape_ = std::make_unique<btStaticPlaneShape>(btVector3(0, 0, 1), height);
  ground_object_ = std::move(object);
  ground_object_->setCollisionShape(ground_shape_.get());
  ground_object_->setUserPointer(&ground_);
  ground_object_->forceActivationState(ISLAND_SLEEPING);
  ground_.object = ground_object_.get();
  world_.addCollisionObject(ground_object_.get(), kStanding, btBroadphaseProxy::AllFilter ^ kStanding);
  wake_all();
}

BodyId BulletWorld::add_body(const BodyDescription& description) {
  const BodyId id{std::ssize(bodies_)};
  const std::string owner = "body " + std::to_string(id.value);
  if (!std::isfinite(description.mass) || !(description.mass > 0)) {
    throw std::invalid_argument(owner + ": mass " + std::to_string(description.mass) + "; it must be above zero");
  }
  const PrincipalInertia inertia =
      principal_inertia(description.inertia, frame_of_only_box(description.parts).value_or(unturned), owner);
  auto body = std::make_unique<Body>();
  body->kind = Touched::Kind::body;
  body->id = id.value;
  body->turned = inertia.turned;
  body->frame = inertia.axes;
  make_parts(description.parts, owner, polyhedra_, *body);

  btRigidBody::btRigidBodyConstructionInfo info(description.mass, nullptr, body->shape(), to_bullet(inertia.moments));
  info.m_linearSleepingThreshold = info.m_angularSleepingThreshold = kSettings.asleep_below;
  body->rigid = std::make_unique<btRigidBody>(info);
  btRigidBody& rigid = *body->rigid;
  set_surface(rigid, description.friction, description.restitution, owner);
  rigid.setFlags(0);  // no gyroscopic terms: FreeSpinWorld turns bodies
  body->ball_radius = ball_radius(description.parts);
  body->mass = description.mass;
  body->moments = to_bullet(inertia.moments);
  rigid.setUserPointer(static_cast<Solid*>(body.get()));
  body->object = &rigid;
  set_continuous(*body);

  bodies_.push_back(std::move(body));
  seen_.emplace_back();
  awake_count_.reset();
  order_.push_back(id);
  set_state(id, {description.pose, description.velocity, description.angular_velocity, false});
  world_.addRigidBody(&rigid, kBodies, btBroadphaseProxy::AllFilter);
  return id;
}

void BulletWorld::set_continuous(Body& body) {
  const double radius = body.ignored == 0 ? body.ball_radius : 0;
  body.rigid->setCcdSweptSphereRadius(0.9 * radius);
  body.rigid->setCcdMotionThreshold(kSettings.continuous_from * radius);
}

void BulletWorld::remove_body(BodyId id) {
  Body& gone = body(id.value);
  while (!gone.hinges.empty()) remove_hinge({*gone.hinges.begin()});
  for (auto hung = cables_.begin(); hung != cables_.end();) {
    const auto one = hung++;
    if (one->second->body == id.value) remove_cable({one->first});
  }
  wake_touching(*gone.object);
  let_go(gone);
  world_.forget_foreseen_contacts();
  forget_ignored_of(Touched::Kind::body, id.value);
  forget_contacts_of(Touched::Kind::body, id.value);
  world_.removeRigidBody(gone.rigid.get());
  bodies_[static_cast<std::size_t>(id.value)].reset();
  awake_count_.reset();
  order_.erase(std::lower_bound(order_.begin(), order_.end(), id));
}

ObstacleId BulletWorld::add_obstacle(const ObstacleDescription& description) {
  const std::string owner = "obstacle " + std::to_string(next_obstacle_);
  auto obstacle = std::make_unique<Obstacle>();
  obstacle->kind = Touched::Kind::obstacle;
  obstacle->id = next_obstacle_;
  obstacle->frame = frame_of_only_box(description.parts).value_or(unturned);
  if (description.parts.empty()) {  // hinges alone hold to it, and those are fixed in space here
    obstacles_.emplace(next_obstacle_, std::move(obstacle));
    return {next_obstacle_++};
  }
  make_parts(description.parts, owner, polyhedra_, *obstacle);
  obstacle->fixed = std::make_unique<btCollisionObject>();
  btCollisionObject& fixed = *obstacle->fixed;
  set_surface(fixed, description.friction, description.restitution, owner);
  fixed.setCollisionShape(obstacle->shape());
  fixed.setWorldTransform(to_bullet(description.pose) * obstacle->frame);
  fixed.setUserPointer(static_cast<Solid*>(obstacle.get()));
  fixed.forceActivationState(ISLAND_SLEEPING);  // else its bounds are brought up to date at every step
  obstacle->object = &fixed;
  world_.addCollisionObject(&fixed, kStanding, btBroadphaseProxy::AllFilter ^ kStanding);
  obstacles_.emplace(next_obstacle_, std::move(obstacle));
  return {next_obstacle_++};
}

void BulletWorld::remove_obstacle(ObstacleId id) {
  Obstacle& gone = obstacle(id.value);
  if (!gone.fixed) {
    obstacles_.erase(id.value);
    return;
  }
  wake_touching(*gone.object);
  world_.forget_foreseen_contacts();
  forget_ignored_of(Touched::Kind::obstacle, id.value);
  forget_contacts_of(Touched::Kind::obstacle, id.value);
  world_.removeCollisionObject(gone.fixed.get());
  obstacles_.erase(id.value);
}

void BulletWorld::move_obstacle(ObstacleId id, const Pose& pose) {
  Obstacle& moved = obstacle(id.value);
  if (!moved.fixed) return;
  wake_touching(*moved.object);
  moved.fixed->setWorldTransform(to_bullet(pose) * moved.frame);
  world_.updateSingleAabb(moved.fixed.get());
}

BodyState BulletWorld::state(BodyId id) const {
  const Body& wanted = body(id.value);
  Seen& seen = seen_[static_cast<std::size_t>(id.value)];
  if (!seen.holds) seen = {read(wanted), true};
  return seen.state;
}

BodyState BulletWorld::read(const Body& seen) {
  const btTransform& frame = seen.rigid->getWorldTransform();
  BodyState state;
  state.pose.position = from_bullet(frame.getOrigin());
  btQuaternion orientation = frame.getRotation();
  if (seen.turned) orientation = orientation * seen.frame.getRotation().inverse();
  state.pose.orientation = from_bullet(orientation);
  state.velocity = from_bullet(seen.rigid->getLinearVelocity());
  state.angular_velocity = from_bullet(seen.rigid->getAngularVelocity());
  state.asleep = !seen.rigid->isActive();
  return state;
}

void BulletWorld::set_state(BodyId id, const BodyState& state) {
  Body& set = body(id.value);
  let_go(set);
  if (!state.pose.position.allFinite() || !state.velocity.allFinite() || !state.angular_velocity.allFinite()) {
    throw std::invalid_argument("body " + std::to_string(id.value) + ": its state is not finite");
  }
  btTransform frame = to_bullet(state.pose);
  if (set.turned) frame = frame * set.frame;
  btRigidBody& rigid = *set.rigid;
  rigid.setLinearVelocity(to_bullet(state.velocity));
  rigid.setAngularVelocity(to_bullet(state.angular_velocity));
  rigid.setCenterOfMassTransform(frame);
  // The step before is over: what it would predict from starts here too.
  rigid.setInterpolationWorldTransform(frame);
  if (rigid.getBroadphaseHandle()) world_.updateSingleAabb(&rigid);
  if (state.asleep) {
    rigid.forceActivationState(ISLAND_SLEEPING);
    seen_[static_cast<std::size_t>(id.value)].holds = false;
    awake_count_.reset();
  } else {
    wake(id);
  }
}

void BulletWorld::apply_impulse(BodyId id, const Vec3& impulse, const Vec3& point) {
  let_go(body(id.value));
  btRigidBody& rigid = *body(id.value).rigid;
  rigid.applyImpulse(to_bullet(impulse), to_bullet(point) - rigid.getCenterOfMassPosition());
  wake(id);
}

void BulletWorld::wake(BodyId id) {
  Body& woken = body(id.value);
  let_go(woken);
  woken.rigid->forceActivationState(ACTIVE_TAG);
  woken.rigid->setDeactivationTime(0);
  woken.watched = woken.about_to_rest = false;
  woken.times_still = 0;
  woken.seen_at = woken.rigid->getWorldTransform();
  woken.seen_for = 0;
  seen_[static_cast<std::size_t>(id.value)].holds = false;
  awake_count_.reset();
}

void BulletWorld::wake_all() {
  for (const BodyId id : order_) wake(id);
}

void BulletWorld::wake_touching(const btCollisionObject& object) {
  for (const btPersistentManifold* manifold : manifolds_of(object)) {
    if (manifold->getNumContacts() == 0) continue;
    for (const btCollisionObject* touching : {manifold->getBody0(), manifold->getBody1()}) {
      const auto* solid = static_cast<const Solid*>(touching->getUserPointer());
      if (solid->kind == Touched::Kind::body) wake({solid->id});
    }
  }
}

std::size_t BulletWorld::awake_count() const {
  if (!awake_count_)
    awake_count_ = static_cast<std::size_t>(
        std::count_if(order_.begin(), order_.end(), [&](BodyId id) { return body(id.value).rigid->isActive(); }));
  return *awake_count_;
}

/// After a step, while what moved is at hand. What slept before it and sleeps still has not moved.
void BulletWorld::read_moved() {
  std::size_t awake = 0;
  for (const BodyId id : order_) {
    const Body& one = body(id.value);
    const bool active = one.rigid->isActive();
    Seen& seen = seen_[static_cast<std::size_t>(id.value)];
    if (active || !seen.holds || !seen.state.asleep) seen = {read(one), true};
    if (active) ++awake;
  }
  awake_count_ = awake;
}

void BulletWorld::step(double dt) {
  if (!(dt > 0) || !std::isfinite(dt))
    throw std::invalid_argument("step of " + std::to_string(dt) + " s; it must be above zero");
  release_separated(dt);
  hold_still();
  if (awake_count() == 0) {
    contacts_.clear();
    return;
  }
  world_.before_solving([&] { let_go_struck(dt); });
  std::vector<std::pair<BodyId, Vec3>> before;
  for (const BodyId id : bodies())
    if (const btRigidBody& one = *body(id.value).rigid; one.isActive())
      before.emplace_back(id, from_bullet(one.getWorldTransform().getOrigin()));
  world_.stepSimulation(dt, 0);
  gather_contacts();
  account_pushes(before, dt);
  read_forces(dt);
  resist_rolling();
  keep_swinging();
  let_settled_sleep(dt);
  let_go_unbalanced();
  find_still(dt);
  for (auto& [id, hinge] : hinges_) read_hinge(*hinge, dt);
  read_cables(dt);
  read_moved();
}

void BulletWorld::resist_rolling() {
  // Bullet limits its own rolling friction by the coefficient alone, which heavy balls do not feel.
  for (Contact& contact : contacts_) {
    const double pressed = std::abs(contact.impulse.dot(contact.normal));
    for (const BodyId id : {contact.body, contact.other.body}) {
      if (id.value < 0 || body(id.value).ball_radius == 0) continue;
      btRigidBody& ball = *body(id.value).rigid;
      const double inverse_inertia = ball.getInvInertiaDiagLocal().x();
      const double spin = ball.getAngularVelocity().length();
      const double slowed =
          std::max(0.0, spin - kSettings.rolling_resistance * body(id.value).ball_radius * pressed * inverse_inertia);
      if (spin == 0) continue;
      ball.setAngularVelocity(ball.getAngularVelocity() * (slowed / spin));
      contact.work_lost += (spin * spin - slowed * slowed) / (2 * inverse_inertia);
    }
  }
}

std::unique_ptr<World> make_sequential_impulse_world() {
  require_double_precision_library();
  return std::make_unique<BulletWorld>();
}

}  // namespace topple::collision
