// Contacts of the last step, from Bullet's manifolds; pairs that are ignored until separated.
#include <BulletCollision/BroadphaseCollision/btCollisionAlgorithm.h>
#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>

#include <algorithm>
#include <map>
#include <stdexcept>
#include <tuple>

#include "bullet/bullet_world.h"
#include "contacts/contact_order.h"

namespace topple::collision {

namespace {

/// Points of a manifold that are farther apart than this (m) and carried nothing are only near.
constexpr double kTouching = 0.001;

/// Mean of a body's velocities before and after the solver at a point: impulse times it is the exact work of the
/// impulse.
btVector3 mean_velocity(const Solid& solid, const btVector3& point) {
  if (solid.kind != Touched::Kind::body) return {0, 0, 0};
  const auto& body = static_cast<const Body&>(solid);
  const SolverVelocities& v = body.velocities;
  const btVector3 arm = point - v.pose.getOrigin();
  return (v.linear_before + v.linear_after + (v.angular_before + v.angular_after).cross(arm)) / 2;
}

btVector3 velocity_now(const Solid& solid, const btVector3& point) {
  if (solid.kind != Touched::Kind::body) return {0, 0, 0};
  const auto& body = static_cast<const Body&>(solid);
  return body.rigid->getVelocityInLocalPoint(point - body.rigid->getCenterOfMassPosition());
}

/// Null for the ground.
const SolidPart* part_at(const Solid& solid, int index, const btVector3& point) {
  if (solid.kind == Touched::Kind::ground) return nullptr;
  // Contacts that Bullet predicts for fast bodies carry no index.
  if (index < 0 && solid.parts.size() > 1) index = nearest_part(solid, solid.object->getWorldTransform(), point);
  return &solid.part(index);
}

/// The solid that a contact names first is the body with the lower id.
bool comes_first(const Solid& a, const Solid& b) {
  return std::make_tuple(a.kind, a.id) < std::make_tuple(b.kind, b.id);
}

Contact point_contact(const Solid& first, const Solid& second, const btManifoldPoint& point) {
  const btVector3 at = point.getPositionWorldOnB();
  const btVector3 on_first = point.m_normalWorldOnB * point.m_appliedImpulse +
                             point.m_lateralFrictionDir1 * point.m_appliedImpulseLateral1 +
                             point.m_lateralFrictionDir2 * point.m_appliedImpulseLateral2;
  const bool forward = comes_first(first, second);
  const Solid& body = forward ? first : second;
  const Solid& other = forward ? second : first;
  Contact contact;
  contact.body.value = body.id;
  const SolidPart& part = *part_at(body, forward ? point.m_index0 : point.m_index1, at);
  const SolidPart* others_part = part_at(other, forward ? point.m_index1 : point.m_index0, at);
  contact.part_tag = part.tag;
  contact.other = touched(other, others_part ? others_part->tag : -1);
  contact.depth = std::max(0.0, -point.getDistance());
  contact.thickness = others_part ? std::min(part.thickness, others_part->thickness) : part.thickness;
  contact.point = from_bullet(at);
  contact.normal = from_bullet(point.m_normalWorldOnB) * (forward ? -1 : 1);
  contact.impulse = from_bullet(on_first) * (forward ? -1 : 1);
  contact.approach_speed =
      (from_bullet(velocity_now(body, at)) - from_bullet(velocity_now(other, at))).dot(contact.normal);
  // The solver takes each body at its own point: deep or not yet touching, friction's arms are not the same.
  const btVector3 &own = forward ? point.getPositionWorldOnA() : at,
                  &others = forward ? at : point.getPositionWorldOnA();
  contact.work_lost =
      contact.impulse.dot(from_bullet(mean_velocity(body, own)) - from_bullet(mean_velocity(other, others)));
  return contact;
}

void add_manifold(const btPersistentManifold& manifold, std::vector<Contact>& points) {
  const auto& first = *static_cast<const Solid*>(manifold.getBody0()->getUserPointer());
  const auto& second = *static_cast<const Solid*>(manifold.getBody1()->getUserPointer());
  for (int i = 0; i < manifold.getNumContacts(); ++i) {
    const btManifoldPoint& point = manifold.getContactPoint(i);
    // A point may end without a normal impulse and keep the friction that it had while it still had one: Bullet's
    // solver leaves it there, and the bodies have it.
    const bool pushes =
        point.m_appliedImpulse > 0 || point.m_appliedImpulseLateral1 != 0 || point.m_appliedImpulseLateral2 != 0;
    if (!pushes && point.getDistance() > kTouching) continue;
    points.push_back(point_contact(first, second, point));
  }
}

/// One contact of points that share their parts: impulses and work add up; place, normal and speed are weighted by
/// impulse.
Contact merged(std::span<const Contact* const> points) {
  Contact sum = *points.front();
  sum.point.setZero();
  sum.normal.setZero();
  sum.impulse.setZero();
  sum.approach_speed = sum.work_lost = 0;
  double total = 0;
  for (const Contact* point : points) total += point->impulse.norm();
  for (const Contact* one : points) {
    const Contact& point = *one;
    const double share = total > 0 ? point.impulse.norm() / total : 1.0 / static_cast<double>(points.size());
    sum.point += share * point.point;
    sum.normal += share * point.normal;
    sum.approach_speed += share * point.approach_speed;
    sum.impulse += point.impulse;
    sum.work_lost += point.work_lost;
    sum.depth = std::max(sum.depth, point.depth);
    if (sum.corner_count < 4) sum.corners[static_cast<std::size_t>(sum.corner_count++)] = point.point;
  }
  for (const Contact* one : points) sum.moment += (one->point - sum.point).cross(one->impulse);
  if (sum.normal.norm() < 1e-9) sum.normal = points.front()->normal;  // squeezed from both sides
  sum.normal.normalize();
  return sum;
}

}  // namespace

void BulletWorld::gather_contacts() {
  std::vector<Contact>& found = points_;
  found.clear();
  for (int i = 0; i < dispatcher_.getNumManifolds(); ++i) {
    const btPersistentManifold& manifold = *dispatcher_.getManifoldByIndexInternal(i);
    if (manifold.getNumContacts() > 0 && (manifold.getBody0()->isActive() || manifold.getBody1()->isActive()))
      add_manifold(manifold, found);
  }
  const auto by_place = [](const Contact* a, const Contact* b) {
    const auto first = parts_of(*a), second = parts_of(*b);
    if (first != second) return first < second;
    return std::make_tuple(a->point.x(), a->point.y(), a->point.z()) <
           std::make_tuple(b->point.x(), b->point.y(), b->point.z());
  };
  std::vector<const Contact*> order;  // contacts are large: what is sorted is where they are
  order.reserve(found.size());
  for (const Contact& contact : found) order.push_back(&contact);
  std::sort(order.begin(), order.end(), by_place);
  contacts_.clear();
  for (std::size_t begin = 0, end = 0; begin < order.size(); begin = end) {
    while (end < order.size() && same_parts(*order[begin], *order[end])) ++end;
    contacts_.push_back(merged(std::span(order).subspan(begin, end - begin)));
    contacts_.back().persistent =
        std::binary_search(touching_.begin(), touching_.end(), contacts_.back(), before_by_parts);
  }
  std::erase_if(touching_, [&](const Contact& contact) { return is_awake(contact); });
  next_.clear();
  std::merge(touching_.begin(), touching_.end(), contacts_.begin(), contacts_.end(), std::back_inserter(next_),
             before_by_parts);
  std::swap(touching_, next_);
}

/// What bodies were moved beyond their velocities, out of each other, is work of their contacts as well.
void BulletWorld::account_pushes(std::span<const std::pair<BodyId, Vec3>> before, double dt) {
  std::map<std::int64_t, Contact*> largest;
  for (Contact& contact : contacts_)
    for (const BodyId id : {contact.body, contact.other.body}) {
      Contact*& known = largest[id.value];
      if (!known || contact.impulse.norm() > known->impulse.norm()) known = &contact;
    }
  const Vec3 gravity = from_bullet(world_.getGravity());
  for (const auto& [id, at] : before) {
    const auto contact = largest.find(id.value);
    if (contact == largest.end()) continue;
    const btRigidBody& moved = *body(id.value).rigid;
    const Vec3 free = at + dt * from_bullet(moved.getLinearVelocity());
    contact->second->work_lost +=
        body(id.value).mass * gravity.dot(from_bullet(moved.getWorldTransform().getOrigin()) - free);
  }
}

bool BulletWorld::is_awake(const Contact& contact) const {
  const auto awake = [&](BodyId id) { return id.value >= 0 && body(id.value).rigid->isActive(); };
  return awake(contact.body) || awake(contact.other.body);
}

void BulletWorld::forget_contacts_of(Touched::Kind kind, std::int64_t id) {
  const auto names = [&](const Contact& contact) {
    if (kind == Touched::Kind::obstacle) return contact.other.obstacle.value == id;
    return contact.body.value == id || contact.other.body.value == id;
  };
  forces_.forget(kind, id);
  std::erase_if(touching_, names);
  std::erase_if(contacts_, names);
}

const Solid& BulletWorld::solid(const SolidPair& pair) const {
  if (pair.kind == Touched::Kind::body) return body(pair.other);
  const auto found = obstacles_.find(pair.other);
  if (found == obstacles_.end())
    throw std::out_of_range("obstacle " + std::to_string(pair.other) + " is not in the world");
  return *found->second;
}

void BulletWorld::ignore_until_separated(BodyId id, const Touched& other) {
  if (other.kind == Touched::Kind::ground)
    throw std::invalid_argument("the ground cannot be ignored; accepted: a body, an obstacle");
  SolidPair pair{id.value, other.kind, other.kind == Touched::Kind::body ? other.body.value : other.obstacle.value};
  static_cast<void>(body(pair.body));
  static_cast<void>(solid(pair));
  if (pair.kind == Touched::Kind::body) {
    if (pair.body == pair.other)
      throw std::invalid_argument("body " + std::to_string(pair.body) + " cannot ignore itself");
    if (pair.body > pair.other) std::swap(pair.body, pair.other);
  }
  if (ignored_.insert(pair).second) ignore(pair, true);
}

void BulletWorld::ignore(const SolidPair& pair, bool ignored) {
  const Solid& other = solid(pair);
  const auto count = [&](Body& which) {
    which.ignored += ignored ? 1 : -1;
    set_continuous(which);  // Bullet's search for tunnelling does not know of ignored pairs
  };
  Body& first = body(pair.body);
  first.rigid->setIgnoreCollisionCheck(other.object, ignored);
  other.object->setIgnoreCollisionCheck(first.object, ignored);
  count(first);
  if (pair.kind == Touched::Kind::body) count(body(pair.other));
  if (!ignored) return;
  // Contacts found before stay in the pair's cache: forget them.
  for (btPersistentManifold* manifold : manifolds_of(*first.object, other.object)) manifold->clearManifold();
}

/// Those between an object and any other, or a certain one. They are found by the pairs whose bounds meet: these lie
/// side by side, and there are far fewer of one object than manifolds in the world.
std::vector<btPersistentManifold*> BulletWorld::manifolds_of(const btCollisionObject& object,
                                                             const btCollisionObject* other) {
  btManifoldArray of_pair;
  std::vector<btPersistentManifold*> found;
  const auto take = [&](const btBroadphasePair& pair) {
    if (!pair.m_algorithm) return;
    of_pair.resize(0);
    pair.m_algorithm->getAllContactManifolds(of_pair);
    for (int i = 0; i < of_pair.size(); ++i) found.push_back(of_pair[i]);
  };
  btOverlappingPairCache& cache = *broadphase_.getOverlappingPairCache();
  btBroadphaseProxy* const own = const_cast<btBroadphaseProxy*>(object.getBroadphaseHandle());
  if (other && own && other->getBroadphaseHandle()) {
    const btBroadphaseProxy* const others = other->getBroadphaseHandle();
    if (const btBroadphasePair* pair = cache.findPair(own, const_cast<btBroadphaseProxy*>(others))) take(*pair);
  } else if (!other && own) {
    const btBroadphasePairArray& pairs = cache.getOverlappingPairArray();
    for (int i = 0; i < pairs.size(); ++i)
      if (pairs[i].m_pProxy0 == own || pairs[i].m_pProxy1 == own) take(pairs[i]);
  }
  const auto& foreseen = world_.foreseen_contacts();
  for (int i = 0; i < foreseen.size(); ++i) {
    const btCollisionObject *first = foreseen[i]->getBody0(), *second = foreseen[i]->getBody1();
    const btCollisionObject* met = first == &object ? second : second == &object ? first : nullptr;
    if (met && (!other || met == other)) found.push_back(foreseen[i]);
  }
  return found;
}

void BulletWorld::forget_ignored_of(Touched::Kind kind, std::int64_t id) {
  for (auto pair = ignored_.begin(); pair != ignored_.end();) {
    const bool names = (pair->kind == kind && pair->other == id) || (kind == Touched::Kind::body && pair->body == id);
    if (names) ignore(*pair, false);
    pair = names ? ignored_.erase(pair) : std::next(pair);
  }
}

namespace {

bool bounds_meet(const btConvexShape& a, const btTransform& a_pose, const btConvexShape& b, const btTransform& b_pose) {
  btVector3 a_low, a_high, b_low, b_high;
  a.getAabb(a_pose, a_low, a_high);
  b.getAabb(b_pose, b_low, b_high);
  return TestAabbAgainstAabb2(a_low, a_high, b_low, b_high);
}

bool separated(const Solid& first, const Solid& second) {
  const btTransform &a = first.object->getWorldTransform(), &b = second.object->getWorldTransform();
  for (const SolidPart& part : first.parts) {
    for (const SolidPart& other : second.parts) {
      if (!bounds_meet(*part.shape, a * part.local, *other.shape, b * other.local)) continue;
      if (distance(part, a, other, b) <= 0) return false;
    }
  }
  return true;
}

}  // namespace

void BulletWorld::release_separated(double dt) {
  for (auto pair = ignored_.begin(); pair != ignored_.end();) {
    const Body& first = body(pair->body);
    const Solid& other = solid(*pair);
    const bool other_moves = pair->kind == Touched::Kind::body && other.object->isActive();
    const bool moves = first.object->isActive() || other_moves;
    const bool apart = moves && separated(first, other) && !still_to_pass(first, other, other_moves, dt);
    if (apart) ignore(*pair, false);
    pair = apart ? ignored_.erase(pair) : std::next(pair);
  }
}

}  // namespace topple::collision
