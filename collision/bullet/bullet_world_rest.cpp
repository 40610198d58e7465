// Rest: whole heaps that have settled fall asleep, and single bodies of a heap that still moves are held still.
//
// Bullet's solver leaves a large heap creeping: each body moves a little, because those that it lies on do. What lies
// still within it is therefore held in its place as if it stood, from the ground up: it takes part in no step, and to
// its caller it is asleep. That is what stabilization in engines for games does; here it must not hide forces, for
// heaps load what stands. So a body is held only when it is in balance, by forces averaged over some steps, and rests
// on what is held, too, or stands. It is let go when
// - something comes upon it as an impact (faster than 2 g dt), before that is solved for, together with as much of the
//   heap round it as the impact could move at a noticeable speed;
// - what presses on it changes by a good part of what it carries, or that times its size as a moment: what it rests on
//   gives or goes, something comes to lie on it;
// - it, or what it touches, is changed or taken away from outside.
#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>

#include <algorithm>
#include <map>
#include <set>

#include "bullet/bullet_world.h"

namespace topple::collision {

namespace {

struct RestSettings {
  double settled_time = 2;    ///< s: things that touch each other rest when in such a time they have come less than ...
  double settled_mean = 0.1;  ///< m on the whole (root mean square by mass), and ...
  double settled_single = 1;  ///< m each by its centre: see let_settled_sleep()

  double look_time = 0.25;      ///< s between looks for single bodies of a heap that are still
  double still_time = 0.5;      ///< s: a body is still while in each such time no point of it comes farther than ...
  double still = 0.025;         ///< m: as fast as a whole heap that falls asleep. It must be so ...
  int still_times = 2;          ///< times in a row, once where it was held before
  double slow = 0.1;            ///< m in the same time: what moves less far is held, too, where it bears what is still
  double out_of_balance = 0.4;  ///< of what a body carries, its own weight included: more out of balance it is not
                                ///< taken to rest, and when what presses on it changes by more it is let go
  double on_standing = 0.2;     ///< the same for what lies on something that stands, on others or straight
  double bearing = 0.25;        ///< of a body's weight: what presses it up with more bears it
  double calm = 0.25;  ///< m/s: an impact lets go as much of the heap as its momentum would move faster than that
};
constexpr RestSettings kRest;

}  // namespace

/// Bullet lets things that touch each other sleep when each of them is still. In a large pile of unequal bodies that
/// never comes: the solver's remaining error keeps light ones trembling between heavy ones, on the spot. Such a pile
/// rests when it is not going anywhere.
void BulletWorld::let_settled_sleep(double dt) {
  watched_for_ += dt;
  if (watched_for_ < kRest.settled_time) return;
  watched_for_ = 0;
  struct Island {
    double mass = 0, sum = 0, farthest = 0;
  };
  std::map<int, Island> islands;
  for (const BodyId id : order_) {
    const Body& one = body(id.value);
    if (!one.rigid->isActive()) continue;
    const btTransform& now = one.rigid->getWorldTransform();
    const double turned = now.getRotation().angleShortestPath(one.watched_at.getRotation());
    const double away = (now.getOrigin() - one.watched_at.getOrigin()).length();
    const double moved = away + one.reach * turned;
    const double mass = 1 / one.rigid->getInvMass();
    Island& island = islands[one.rigid->getIslandTag()];
    island.mass += mass;
    island.sum += mass * moved * moved;
    island.farthest = std::max(island.farthest, one.watched ? away : BT_LARGE_FLOAT);
  }
  for (const BodyId id : order_) {
    Body& one = body(id.value);
    one.watched = one.rigid->isActive();
    if (!one.watched || one.swings) continue;
    one.watched_at = one.rigid->getWorldTransform();
    const Island& island = islands[one.rigid->getIslandTag()];
    if (island.sum < kRest.settled_mean * kRest.settled_mean * island.mass && island.farthest < kRest.settled_single)
      one.rigid->setActivationState(WANTS_DEACTIVATION);
  }
}

/// Those that the last look found still.
void BulletWorld::hold_still() {
  std::vector<char> taken;
  for (const BodyId id : order_) {
    Body& one = body(id.value);
    if (!one.about_to_rest) continue;
    one.about_to_rest = false;
    btRigidBody& rigid = *one.rigid;
    rigid.setLinearVelocity({0, 0, 0});
    rigid.setAngularVelocity({0, 0, 0});
    rigid.setInterpolationWorldTransform(rigid.getWorldTransform());
    rigid.setInterpolationLinearVelocity({0, 0, 0});
    rigid.setInterpolationAngularVelocity({0, 0, 0});
    world_.updateSingleAabb(&rigid);
    rigid.setMassProps(0, {0, 0, 0});  // to Bullet it stands: it joins no islands
    rigid.updateInertiaTensor();
    rigid.forceActivationState(ISLAND_SLEEPING);
    one.held_still = true;
    ++held_count_;
    taken.resize(bodies_.size());
    taken[static_cast<std::size_t>(id.value)] = 1;
    seen_[static_cast<std::size_t>(id.value)].holds = false;
  }
  if (taken.empty()) return;
  awake_count_.reset();
  forces_.trust([&](std::int64_t id) { return taken[static_cast<std::size_t>(id)] != 0; });
}

void BulletWorld::let_go(Body& one) {
  if (!one.held_still) return;
  one.held_still = false;
  --held_count_;
  btRigidBody& rigid = *one.rigid;
  rigid.setMassProps(one.mass, one.moments);
  rigid.updateInertiaTensor();
  rigid.forceActivationState(ACTIVE_TAG);
  rigid.setDeactivationTime(0);
  one.watched = true;  // where it has been all the time
  one.watched_at = one.seen_at = rigid.getWorldTransform();
  one.times_still = kRest.still_times - 1;
  one.seen_for = 0;
  seen_[static_cast<std::size_t>(one.id)].holds = false;
  awake_count_.reset();
}

namespace {

/// The greatest momentum with which a manifold's bodies come upon each other as an impact within dt; 0: not at all.
double impact_momentum(const btPersistentManifold& manifold, const Body& moving, const btVector3& gravity, double dt) {
  const double resting_speed = 2 * gravity.length() * dt;
  const double side = manifold.getBody0() == moving.object ? -1 : 1;  // normals are from the second to the first
  double fastest = 0;
  for (int i = 0; i < manifold.getNumContacts(); ++i) {
    const btManifoldPoint& point = manifold.getContactPoint(i);
    const btVector3 arm = point.getPositionWorldOnB() - moving.rigid->getCenterOfMassPosition();
    const double approach =
        side * point.m_normalWorldOnB.dot(moving.rigid->getVelocityInLocalPoint(arm) + gravity * dt);
    if (approach > resting_speed && point.getDistance() < approach * dt) fastest = std::max(fastest, approach);
  }
  return fastest * moving.mass;
}

}  // namespace

void BulletWorld::let_go_struck(double dt) {
  if (held_count_ == 0) return;
  std::map<std::int64_t, double> impacts;  // by the body that is struck, N s
  for (int i = 0; i < dispatcher_.getNumManifolds(); ++i) {
    const btPersistentManifold& manifold = *dispatcher_.getManifoldByIndexInternal(i);
    if (manifold.getNumContacts() == 0) continue;
    const auto &first = *static_cast<const Solid*>(manifold.getBody0()->getUserPointer()),
               &second = *static_cast<const Solid*>(manifold.getBody1()->getUserPointer());
    if (first.kind != Touched::Kind::body || second.kind != Touched::Kind::body) continue;
    const auto &a = static_cast<const Body&>(first), &b = static_cast<const Body&>(second);
    if (a.held_still == b.held_still || !(a.rigid->isActive() || b.rigid->isActive())) continue;
    const double momentum = impact_momentum(manifold, a.held_still ? b : a, world_.getGravity(), dt);
    if (momentum > 0) {
      double& most = impacts[(a.held_still ? a : b).id];
      most = std::max(most, momentum);
    }
  }
  if (impacts.empty()) return;
  std::vector<std::pair<std::int64_t, std::int64_t>> neighbours;
  for (const Contact& contact : touching_) {
    if (contact.other.kind != Touched::Kind::body) continue;
    neighbours.emplace_back(contact.body.value, contact.other.body.value);
    neighbours.emplace_back(contact.other.body.value, contact.body.value);
  }
  std::sort(neighbours.begin(), neighbours.end());
  for (const auto& [struck, momentum] : impacts) {
    std::vector<std::int64_t> reached{struck};
    std::set<std::int64_t> known{struck};
    double moved = 0;
    for (std::size_t i = 0; i < reached.size() && (i == 0 || moved < momentum / kRest.calm); ++i) {
      Body& one = body(reached[i]);
      moved += one.mass;
      if (one.held_still) {
        let_go(one);
        one.rigid->applyGravity();  // this step's, which the world gave to those awake at its beginning
      }
      auto next = std::lower_bound(neighbours.begin(), neighbours.end(), std::make_pair(reached[i], std::int64_t{-1}));
      for (; next != neighbours.end() && next->first == reached[i]; ++next)
        if (known.insert(next->second).second) reached.push_back(next->second);
    }
  }
}

void BulletWorld::read_forces(double dt) {
  const auto held = [&](std::int64_t id) { return body(id).held_still; };
  const auto awake = [&](std::int64_t id) { return body(id).rigid->isActive(); };
  forces_.read(
      contacts_, dt,
      [&](const SolidPair& pair) {
        return awake(pair.body) || (pair.kind == Touched::Kind::body && awake(pair.other));
      },
      [&](const SolidPair& pair) { return held(pair.body) || (pair.kind == Touched::Kind::body && held(pair.other)); });
}

namespace {
double tolerance(const Body& body) { return body.on_standing ? kRest.on_standing : kRest.out_of_balance; }
}  // namespace

void BulletWorld::let_go_unbalanced() {
  if (held_count_ == 0) return;
  std::vector<Wrench> changes(bodies_.size());
  std::vector<double> borne(bodies_.size(), 0);  // up, by what it was taken to rest on, N
  const Vec3 up = -from_bullet(world_.getGravity()).normalized();
  for (const ContactForces::Pair& pair : forces_.pairs()) {
    const auto body = static_cast<std::size_t>(pair.who.body);
    changes[body] += -1 * (pair.on_other - pair.trusted_by[0]);
    borne[body] += std::max(0.0, -up.dot(pair.trusted_by[0].force));
    if (pair.who.kind != Touched::Kind::body) continue;
    const auto other = static_cast<std::size_t>(pair.who.other);
    changes[other] += pair.on_other - pair.trusted_by[1];
    borne[other] += std::max(0.0, up.dot(pair.trusted_by[1].force));
  }
  for (const BodyId id : order_) {
    Body& one = body(id.value);
    if (!one.held_still) continue;
    const Wrench& change = changes[static_cast<std::size_t>(id.value)];
    const Vec3 moment = change.moment - from_bullet(one.rigid->getCenterOfMassPosition()).cross(change.force);
    const double weight = one.mass * world_.getGravity().length();
    const double allowed = tolerance(one) * std::max(weight, borne[static_cast<std::size_t>(id.value)]);
    if (change.force.norm() > allowed || moment.norm() > allowed * one.reach) let_go(one);
  }
}

/// By id: 2 where a body has been still for long enough, 1 where it is slow; both in balance.
std::vector<char> BulletWorld::still_bodies() {
  std::vector<char> still(bodies_.size(), 0);
  for (const BodyId id : order_) {
    Body& one = body(id.value);
    if (!one.rigid->isActive() || !one.hinges.empty()) continue;
    const btTransform& now = one.rigid->getWorldTransform();
    const auto moved = [&] {
      return (now.getOrigin() - one.seen_at.getOrigin()).length() +
             one.reach * now.getRotation().angleShortestPath(one.seen_at.getRotation());
    };
    const double speed = one.rigid->getLinearVelocity().length() + one.reach * one.rigid->getAngularVelocity().length();
    const bool whole_time = one.seen_for >= kRest.still_time;
    const bool slow = moved() < (whole_time ? kRest.still : kRest.slow);
    if (!slow)
      one.times_still = 0;
    else if (whole_time)
      ++one.times_still;
    if (whole_time) {
      one.seen_at = now;
      one.seen_for = 0;
    }
    if (slow && speed * kRest.still_time < kRest.slow)
      still[static_cast<std::size_t>(id.value)] = one.times_still >= kRest.still_times ? 2 : 1;
  }
  for (const auto& [id, cable] : cables_) still[static_cast<std::size_t>(cable->body)] = 0;
  std::vector<Vec3> forces(bodies_.size(), Vec3::Zero());
  std::vector<double> borne(bodies_.size(), 0);
  std::vector<char> in_heap(bodies_.size(), 0);  // what lies alone is Bullet's own business
  const Vec3 gravity = from_bullet(world_.getGravity()), up = -gravity.normalized();
  const auto press = [&](std::int64_t on, const Vec3& force) {
    forces[static_cast<std::size_t>(on)] += force;
    borne[static_cast<std::size_t>(on)] += std::max(0.0, up.dot(force));
  };
  for (const ContactForces::Pair& pair : forces_.pairs()) {
    press(pair.who.body, -pair.on_other.force);
    if (pair.who.kind != Touched::Kind::body) continue;
    press(pair.who.other, pair.on_other.force);
    in_heap[static_cast<std::size_t>(pair.who.body)] = in_heap[static_cast<std::size_t>(pair.who.other)] = 1;
  }
  for (const BodyId id : order_) {
    const auto one = static_cast<std::size_t>(id.value);
    const Vec3 weight = body(id.value).mass * gravity;
    if (!in_heap[one] ||
        !((forces[one] + weight).norm() < tolerance(body(id.value)) * std::max(weight.norm(), borne[one])))
      still[one] = 0;
  }
  return still;
}

/// What bears what with a good part of its weight. `on_standing`: those that something that stands bears.
std::vector<BulletWorld::Bearing> BulletWorld::bearings(std::vector<std::int64_t>& on_standing) const {
  std::vector<Bearing> found;
  const Vec3 gravity = from_bullet(world_.getGravity());
  const auto bears = [&](std::int64_t borne, const Vec3& force) {
    return -force.dot(gravity) > kRest.bearing * body(borne).mass * gravity.squaredNorm();
  };
  for (const ContactForces::Pair& pair : forces_.pairs()) {
    const Vec3& force = pair.on_other.force;
    const SolidPair& who = pair.who;
    if (who.kind == Touched::Kind::obstacle && bears(who.body, -force)) on_standing.push_back(who.body);
    if (who.kind != Touched::Kind::body) continue;
    if (bears(who.body, -force)) found.push_back({who.body, who.other});
    if (bears(who.other, force)) found.push_back({who.other, who.body});
  }
  return found;
}

/// From the ground up: what bears a body must be held, too, or stand. What is slow goes along where it bears what is
/// still.
void BulletWorld::find_still(double dt) {
  for (const BodyId id : order_) body(id.value).seen_for += dt;
  looked_for_ += dt;
  if (looked_for_ < kRest.look_time) return;
  looked_for_ = 0;
  std::vector<std::int64_t> on_standing;
  const std::vector<Bearing> bearings = this->bearings(on_standing);
  const auto until_settled = [&](const auto& changes) {
    for (bool changed = true; changed;) {
      changed = false;
      for (const Bearing& one : bearings) changed = changes(one) || changed;
    }
  };
  for (const BodyId id : order_) body(id.value).on_standing = false;
  for (const std::int64_t id : on_standing) body(id).on_standing = true;
  until_settled([&](const Bearing& one) {
    if (!body(one.bearer).on_standing || body(one.borne).on_standing) return false;
    return body(one.borne).on_standing = true;
  });
  std::vector<char> still = still_bodies();
  const auto of = [&](std::int64_t id) -> char& { return still[static_cast<std::size_t>(id)]; };
  until_settled([&](const Bearing& one) {
    if (of(one.borne) == 0 || of(one.bearer) != 0 || !body(one.bearer).rigid->isActive()) return false;
    of(one.borne) = 0;
    return true;
  });
  until_settled([&](const Bearing& one) {
    if (of(one.borne) != 2 || of(one.bearer) != 1) return false;
    of(one.bearer) = 2;
    return true;
  });
  for (const BodyId id : order_)
    if (of(id.value) == 2) body(id.value).about_to_rest = true;
}

}  // namespace topple::collision
