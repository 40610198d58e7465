// What awake bodies will touch, rays, and queries of space. Nothing here moves anything.
#include <BulletCollision/CollisionDispatch/btCollisionWorld.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "bullet/bullet_world.h"
#include "contacts/moving_pairs.h"
#include "contacts/touch_contact.h"

namespace topple::collision {

namespace {

struct Candidates : btBroadphaseAabbCallback {
  std::vector<const Solid*> solids;
  bool process(const btBroadphaseProxy* proxy) override {
    solids.push_back(
        static_cast<const Solid*>(static_cast<const btCollisionObject*>(proxy->m_clientObject)->getUserPointer()));
    return true;
  }
};

struct NearestHit : btCollisionWorld::ClosestRayResultCallback {
  int child = -1;
  using ClosestRayResultCallback::ClosestRayResultCallback;
  btScalar addSingleResult(btCollisionWorld::LocalRayResult& result, bool normal_in_world) override {
    child = result.m_localShapeInfo ? result.m_localShapeInfo->m_triangleIndex : -1;
    return ClosestRayResultCallback::addSingleResult(result, normal_in_world);
  }
};

}  // namespace

struct BulletWorld::Mover {
  const Body* body = nullptr;
  Motion motion;
  std::vector<Bounds> parts;
  Bounds whole;
};

Motion BulletWorld::motion_of(const Body& body, double dt) const {
  const btVector3 gravity = world_.getGravity();
  Motion motion;
  motion.start = body.rigid->getWorldTransform();
  motion.acceleration = body.rigid->isActive() ? gravity : btVector3(0, 0, 0);
  // Stored velocities are those of mid-step.
  motion.velocity = body.rigid->getLinearVelocity() + motion.acceleration * (dt / 2);
  motion.angular_velocity = body.rigid->getAngularVelocity();
  return motion;
}

BulletWorld::Mover BulletWorld::mover_of(const Body& body, const Motion& motion, double duration) {
  Mover mover;
  mover.body = &body;
  mover.motion = motion;
  for (const SolidPart& part : body.parts) mover.parts.push_back(swept_bounds(part, motion, duration));
  mover.whole = mover.parts.front();
  for (const Bounds& part : mover.parts) {
    mover.whole.low.setMin(part.low);
    mover.whole.high.setMax(part.high);
  }
  return mover;
}

std::vector<BulletWorld::Mover> BulletWorld::movers(double dt) const {
  std::vector<Mover> result;
  for (const BodyId id : order_) {
    const Body& one = body(id.value);
    if (one.rigid->isActive()) result.push_back(mover_of(one, motion_of(one, dt), dt));
  }
  return result;
}

void BulletWorld::sweep_pair(const Mover& mover, const Solid& other, const Motion& other_motion, double dt,
                             std::vector<Contact>& found) const {
  if (!mover.body->object->checkCollideWith(other.object) || !other.object->checkCollideWith(mover.body->object))
    return;
  find_touches(mover, other, other_motion, dt, found);
}

/// Of each part of the one with each part of the other.
void BulletWorld::find_touches(const Mover& mover, const Solid& other, const Motion& other_motion, double dt,
                               std::vector<Contact>& found) {
  for (const SolidPart& other_part : other.parts) {
    const Bounds other_bounds = swept_bounds(other_part, other_motion, dt);
    if (!other_bounds.meets(mover.whole)) continue;
    for (std::size_t i = 0; i < mover.parts.size(); ++i) {
      if (!mover.parts[i].meets(other_bounds)) continue;
      const SolidPart& part = mover.body->parts[i];
      const std::optional<Touch> touch = first_touch(part, mover.motion, other_part, other_motion, dt);
      if (touch) found.push_back(contact_of(*mover.body, part.tag, other, other_part.tag, *touch));
    }
  }
}

/// Whether they meet within this step or the next, faster than what rests does: one that is about to go through the
/// other. (This step alone would not do: who is told at the end of a step to pass has yet to arrive.)
bool BulletWorld::still_to_pass(const Body& first, const Solid& other, bool other_moves, double dt) const {
  const double ahead = 2 * dt;
  Motion other_motion;
  other_motion.start = other.object->getWorldTransform();
  if (other_moves) other_motion = motion_of(static_cast<const Body&>(other), dt);
  const double resting_speed = 2 * world_.getGravity().length() * dt;
  std::vector<Contact> found;
  find_touches(mover_of(first, motion_of(first, dt), ahead), other, other_motion, ahead, found);
  return std::any_of(found.begin(), found.end(),
                     [&](const Contact& contact) { return contact.approach_speed > resting_speed; });
}

void BulletWorld::sweep_ground(const Mover& mover, double dt, double least_speed, std::vector<Contact>& found) const {
  if (!ground_object_ || mover.whole.low.z() > ground_height_) return;
  if (fastest_closing(*mover.body, mover.motion, ground_, {}, dt) < least_speed) return;
  for (std::size_t i = 0; i < mover.parts.size(); ++i) {
    if (mover.parts[i].low.z() > ground_height_) continue;
    const SolidPart& part = mover.body->parts[i];
    const std::optional<Touch> touch = first_touch_of_ground(part, mover.motion, ground_height_, dt);
    if (touch) found.push_back(contact_of(*mover.body, part.tag, ground_, -1, *touch));
  }
}

void BulletWorld::sweep_standing(const Mover& mover, const SweepRange& range, std::vector<Contact>& found) const {
  const auto [what, dt, least_speed] = range;
  Candidates candidates;
  // Bullet's query changes nothing, but is not declared so.
  const_cast<btDbvtBroadphase&>(broadphase_).aabbTest(mover.whole.low, mover.whole.high, candidates);
  for (const Solid* other : candidates.solids) {
    if (other->kind == Touched::Kind::ground) continue;
    if (other->kind == Touched::Kind::body && (what == Sweep::obstacles || other->object->isActive())) continue;
    Motion still;
    still.start = other->object->getWorldTransform();
    if (other->kind == Touched::Kind::body &&
        fastest_closing(*mover.body, mover.motion, *other, still, dt) < least_speed)
      continue;
    sweep_pair(mover, *other, still, dt, found);
  }
}

void BulletWorld::sweep_movers(const std::vector<Mover>& movers, const SweepRange& range,
                               std::vector<Contact>& found) const {
  const auto all = [](const Mover&, const Mover&) { return true; };
  each_moving_pair(movers, range.dt, range.least_speed, all, [&](const Mover& first, const Mover& second) {
    sweep_pair(first, *second.body, second.motion, range.dt, found);
  });
}

std::vector<Contact> BulletWorld::sweep(double dt, const SweepOptions& options) {
  if (!(dt > 0) || !std::isfinite(dt))
    throw std::invalid_argument("sweep of " + std::to_string(dt) + " s; it must be above zero");
  const Sweep what = options.what;
  const double least_speed = options.least_speed;
  const auto& among = options.among;
  release_separated(dt);
  std::vector<Contact> found;
  if (what == Sweep::obstacles && obstacles_.empty()) return found;
  const std::vector<Mover> awake = movers(dt);
  const SweepRange range{what, dt, least_speed};
  for (const Mover& mover : awake) sweep_standing(mover, range, found);
  if (what == Sweep::everything) {
    for (const Mover& mover : awake) sweep_ground(mover, dt, least_speed, found);
    sweep_movers(awake, range, found);
  }
  const auto asked = [&](BodyId id) {
    return std::binary_search(among->begin(), among->end(), id, [](BodyId a, BodyId b) { return a.value < b.value; });
  };
  if (among)
    std::erase_if(found, [&](const Contact& contact) {
      return contact.other.kind != Touched::Kind::obstacle && !asked(contact.body) &&
             !(contact.other.kind == Touched::Kind::body && asked(contact.other.body));
    });
  for (Contact& contact : found) {
    put_lower_first(contact);
    contact.persistent = std::binary_search(touching_.begin(), touching_.end(), contact, before_by_parts);
  }
  std::sort(found.begin(), found.end(), [](const Contact& a, const Contact& b) {
    if (a.time != b.time) return a.time < b.time;
    return before_by_parts(a, b);
  });
  return found;
}

std::optional<RayHit> BulletWorld::ray_cast(const Vec3& from, const Vec3& to) const {
  NearestHit hit(to_bullet(from), to_bullet(to));
  hit.m_collisionFilterMask = btBroadphaseProxy::AllFilter;
  world_.rayTest(hit.m_rayFromWorld, hit.m_rayToWorld, hit);
  if (!hit.hasHit()) return std::nullopt;
  const auto& solid = *static_cast<const Solid*>(hit.m_collisionObject->getUserPointer());
  RayHit result;
  result.what =
      touched(solid, solid.kind == Touched::Kind::ground ? -1 : solid.part(solid.compound ? hit.child : -1).tag);
  result.point = from_bullet(hit.m_hitPointWorld);
  result.normal = from_bullet(hit.m_hitNormalWorld).normalized();
  result.distance = (result.point - from).norm();
  return result;
}

std::vector<ObstacleId> BulletWorld::obstacles_in(const Vec3& low, const Vec3& high) const {
  Candidates candidates;
  const_cast<btDbvtBroadphase&>(broadphase_).aabbTest(to_bullet(low), to_bullet(high), candidates);
  std::vector<ObstacleId> result;
  for (const Solid* solid : candidates.solids) {
    if (solid->kind == Touched::Kind::obstacle) result.push_back({solid->id});
  }
  std::sort(result.begin(), result.end());
  return result;
}

}  // namespace topple::collision
