// What awake bodies will touch, rays, and queries of space. Nothing here moves anything.
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <stdexcept>
#include <tuple>

#include "contacts/apart.h"
#include "contacts/contact_order.h"
#include "debris/debris_world.h"

namespace topple::collision {

namespace {

struct Bounds {
  btVector3 low, high;
  [[nodiscard]] bool meets(const Bounds& other) const { return TestAabbAgainstAabb2(low, high, other.low, other.high); }
};

/// Bounds of a part over its whole path: those at both ends, and how far the path can leave the straight line between.
Bounds swept_bounds(const SolidPart& part, const Motion& motion, double dt) {
  Bounds bounds, end;
  part.shape->getAabb(motion.start * part.local, bounds.low, bounds.high);
  part.shape->getAabb(motion.at(dt) * part.local, end.low, end.high);
  const double turn = std::min(SIMD_PI, motion.angular_velocity.length() * dt);
  const double out = part.reach * (1 - std::cos(turn / 2)) + motion.acceleration.length() * dt * dt / 8 + kSkin;
  bounds.low.setMin(end.low);
  bounds.high.setMax(end.high);
  bounds.low -= btVector3(out, out, out);
  bounds.high += btVector3(out, out, out);
  return bounds;
}

/// Part of a solid, and what it sweeps over.
struct SweptPart {
  std::size_t number;
  Bounds bounds;
};

std::vector<SweptPart> swept_parts(const Solid& solid, const Motion& motion, double dt) {
  std::vector<SweptPart> all;
  for (std::size_t i = 0; i < solid.parts.size(); ++i) all.push_back({i, swept_bounds(solid.parts[i], motion, dt)});
  return all;
}

btTransform transform_of(const Solid& solid) {
  const Placement& placed = static_cast<const TouchingSolid&>(solid).at;
  const Mat3& m = placed.turn;
  return btTransform(btMatrix3x3(m(0, 0), m(0, 1), m(0, 2), m(1, 0), m(1, 1), m(1, 2), m(2, 0), m(2, 1), m(2, 2)),
                     to_bullet(placed.position));
}

Placement placement_of(const btTransform& at) { return {from_bullet(at.getOrigin()), from_bullet(at.getBasis())}; }

bool is_awake(const Solid& solid) {
  return solid.kind == Touched::Kind::body && !static_cast<const DebrisBody&>(solid).asleep;
}

/// No two points of them close faster than this within dt, m/s.
double fastest_closing(const Solid& one, const Motion& motion, const Solid& other, const Motion& other_motion,
                       double dt) {
  return (motion.velocity - other_motion.velocity).length() +
         (motion.acceleration - other_motion.acceleration).length() * dt +
         motion.angular_velocity.length() * one.reach + other_motion.angular_velocity.length() * other.reach;
}

Box3 box_of(const Bounds& bounds) { return {from_bullet(bounds.low), from_bullet(bounds.high)}; }

}  // namespace

struct DebrisWorld::Mover {
  const DebrisBody* body = nullptr;
  Motion motion;
  Placement end;
  std::vector<SweptPart> parts;  ///< all
  Bounds whole;
};

/// What a mover may meet: a solid with its motion, and those of its parts that are near.
struct DebrisWorld::Met {
  const Solid& solid;
  const Motion& motion;
  std::span<const SweptPart> parts;
};

Motion DebrisWorld::motion_of(const DebrisBody& body, double dt) const {
  Motion motion;
  motion.start = transform_of(body);
  if (!body.asleep) {
    // What lies is borne in this step as in the last: it does not fall upon what is near. What was struck falls on.
    const bool struck = body.acceleration.squaredNorm() > gravity_.squaredNorm();
    const Vec3 acceleration = struck ? gravity_ : body.acceleration;
    motion.acceleration = to_bullet(acceleration);
    // Stored velocities are those of mid-step; they came from the middle of the last sub-step.
    const double substep = body.substep_rate > 0 ? 1 / body.substep_rate : 0;
    motion.velocity = to_bullet(body.velocity + gravity_ * (dt / 2) + (acceleration - gravity_) * (substep / 2));
  }
  motion.angular_velocity = to_bullet(body.spin);
  return motion;
}

DebrisWorld::Mover DebrisWorld::mover_of(const DebrisBody& body, const Motion& motion, double duration) {
  Mover mover;
  mover.body = &body;
  mover.motion = motion;
  mover.end = placement_of(motion.at(duration));
  mover.parts = swept_parts(body, motion, duration);
  mover.whole = mover.parts.front().bounds;
  for (const SweptPart& part : mover.parts) {
    mover.whole.low.setMin(part.bounds.low);
    mover.whole.high.setMax(part.bounds.high);
  }
  return mover;
}

std::vector<DebrisWorld::Mover> DebrisWorld::movers(double dt) const {
  std::vector<Mover> result;
  for (const BodyId id : order_) {
    const DebrisBody& one = body(id.value);
    if (!one.asleep) result.push_back(mover_of(one, motion_of(one, dt), dt));
  }
  return result;
}

namespace {

Contact contact_of(const Solid& body, std::int64_t tag, const Solid& other, std::int64_t other_tag,
                   const Touch& touch) {
  Contact contact;
  contact.body.value = body.id;
  contact.part_tag = tag;
  contact.other = touched(other, other_tag);
  contact.point = from_bullet(touch.point);
  contact.normal = from_bullet(touch.normal);
  contact.approach_speed = touch.approach_speed;
  contact.time = touch.time;
  contact.corner_count = touch.corner_count;
  for (int i = 0; i < touch.corner_count; ++i)
    contact.corners[static_cast<std::size_t>(i)] = from_bullet(touch.corners[i]);
  return contact;
}

/// The body with the lower id comes first: turns the contact round when that is the other one.
void put_lower_first(Contact& contact) {
  if (contact.other.kind != Touched::Kind::body || contact.body < contact.other.body) return;
  std::swap(contact.body, contact.other.body);
  std::swap(contact.part_tag, contact.other.part_tag);
  contact.normal = -contact.normal;
}

}  // namespace

void DebrisWorld::sweep_pair(const Mover& mover, const Met& met, const SweepRange& range,
                             std::vector<Contact>& found) const {
  const Solid& other = met.solid;
  const bool other_first = other.kind == Touched::Kind::body && other.id < mover.body->id;
  if (other_first ? ignores(other, *mover.body) : ignores(*mover.body, other)) return;
  // Slow meetings are told of what stands: who lies down on it is told from who strikes it by the caller.
  const double least = other.kind == Touched::Kind::body ? range.least_speed : 0;
  find_touches(mover, met, {range.what, range.dt, least}, found);
}

/// Of each part of the one with each part of the other. What meets slowly matters beside what meets fast alone: a body
/// that comes down on several places at once.
void DebrisWorld::find_touches(const Mover& mover, const Met& met, const SweepRange& range,
                               std::vector<Contact>& found) {
  const double dt = range.dt;
  const Solid& other = met.solid;
  const Motion& other_motion = met.motion;
  const Placement other_end = placement_of(other_motion.at(dt));
  std::vector<std::pair<std::size_t, std::size_t>> slow;
  bool fast = false;
  const auto cast = [&](std::size_t i, std::size_t j) {
    const SolidPart &part = mover.body->parts[i], &other_part = other.parts[j];
    const std::optional<Touch> touch = first_touch(part, mover.motion, other_part, other_motion, dt);
    if (!touch) return;
    found.push_back(contact_of(*mover.body, part.tag, other, other_part.tag, *touch));
    fast = fast || touch->approach_speed >= range.least_speed;
  };
  for (const auto& [j, other_bounds] : met.parts) {
    if (!other_bounds.meets(mover.whole)) continue;
    for (const auto& [i, bounds] : mover.parts) {
      if (!bounds.meets(other_bounds)) continue;
      const Meeting meeting =
          meeting_of({*mover.body, i, mover.motion, mover.end},
                     {static_cast<const TouchingSolid&>(other), j, other_motion, other_end}, dt, range.least_speed);
      if (meeting == Meeting::unknown) cast(i, j);
      if (meeting == Meeting::slow) slow.emplace_back(i, j);
    }
  }
  if (fast)
    for (const auto& [i, j] : slow) cast(i, j);
}

/// Whether they meet within this step or the next, faster than what rests does: one that is about to go through the
/// other. (This step alone would not do: who is told at the end of a step to pass has yet to arrive.)
bool DebrisWorld::still_to_pass(const DebrisBody& first, const Solid& other, bool other_moves, double dt) const {
  const double ahead = 2 * dt;
  Motion other_motion;
  other_motion.start = transform_of(other);
  if (other_moves) other_motion = motion_of(static_cast<const DebrisBody&>(other), dt);
  const double resting_speed = 2 * gravity_.norm() * dt;
  std::vector<Contact> found;
  find_touches(mover_of(first, motion_of(first, dt), ahead),
               {other, other_motion, swept_parts(other, other_motion, ahead)},
               {Sweep::everything, ahead, resting_speed}, found);
  return std::any_of(found.begin(), found.end(),
                     [&](const Contact& contact) { return contact.approach_speed > resting_speed; });
}

void DebrisWorld::sweep_ground(const Mover& mover, const SweepRange& range, std::vector<Contact>& found) const {
  if (!has_ground_ || mover.whole.low.z() > ground_height_) return;
  const double dt = range.dt;
  if (fastest_closing(*mover.body, mover.motion, ground_, {}, dt) < range.least_speed) return;
  for (const auto& [i, bounds] : mover.parts) {
    if (bounds.low.z() > ground_height_) continue;
    const SolidPart& part = mover.body->parts[i];
    const std::optional<Touch> touch = first_touch_of_ground(part, mover.motion, ground_height_, dt);
    if (touch) found.push_back(contact_of(*mover.body, part.tag, ground_, -1, *touch));
  }
}

void DebrisWorld::sweep_standing(const Mover& mover, const SweepRange& range, std::vector<Contact>& found) const {
  const auto [what, dt, least_speed] = range;
  const Box3 box = box_of(mover.whole);
  std::vector<const Collider*> near;  // in order of solids, and of their parts
  const auto take = [&](std::uint32_t index) {
    const Collider& one = pairs_.collider(index);
    if (one.fat.meets(box) && !is_awake(*one.solid)) near.push_back(&one);
  };
  pairs_.each_in(box, true, take);
  if (what == Sweep::everything && awake_count_ < order_.size()) pairs_.each_in(box, false, take);
  std::sort(near.begin(), near.end(), [](const Collider* a, const Collider* b) { return a->order < b->order; });
  for (std::size_t begin = 0, end = 0; begin < near.size(); begin = end) {
    const Solid& other = *near[begin]->solid;
    while (end < near.size() && near[end]->solid == &other) ++end;
    Motion still;
    still.start = transform_of(other);
    if (other.kind == Touched::Kind::body && fastest_closing(*mover.body, mover.motion, other, still, dt) < least_speed)
      continue;
    std::vector<SweptPart> parts;
    for (std::size_t i = begin; i < end; ++i) {
      const auto part = static_cast<std::size_t>(near[i]->part);
      parts.push_back({part, swept_bounds(other.parts[part], still, dt)});
    }
    sweep_pair(mover, {other, still, parts}, range, found);
  }
}

void DebrisWorld::sweep_movers(const std::vector<Mover>& movers, const SweepRange& range,
                               std::vector<Contact>& found) const {
  std::vector<const Mover*> by_x;
  for (const Mover& mover : movers) by_x.push_back(&mover);
  std::sort(by_x.begin(), by_x.end(), [](const Mover* a, const Mover* b) {
    return std::make_tuple(a->whole.low.x(), a->body->id) < std::make_tuple(b->whole.low.x(), b->body->id);
  });
  for (std::size_t i = 0; i < by_x.size(); ++i) {
    for (std::size_t j = i + 1; j < by_x.size() && by_x[j]->whole.low.x() <= by_x[i]->whole.high.x(); ++j) {
      if (!by_x[i]->whole.meets(by_x[j]->whole)) continue;
      const bool forward = by_x[i]->body->id < by_x[j]->body->id;
      const Mover &first = *by_x[forward ? i : j], &second = *by_x[forward ? j : i];
      if (fastest_closing(*first.body, first.motion, *second.body, second.motion, range.dt) < range.least_speed)
        continue;
      sweep_pair(first, {*second.body, second.motion, second.parts}, range, found);
    }
  }
}

std::vector<Contact> DebrisWorld::sweep(double dt, Sweep what, double least_speed) {
  if (!(dt > 0) || !std::isfinite(dt))
    throw std::invalid_argument("sweep of " + std::to_string(dt) + " s; it must be above zero");
  release_separated(dt, false);
  std::vector<Contact> found;
  if (what == Sweep::obstacles && obstacles_.empty()) return found;
  const std::vector<Mover> awake = movers(dt);
  const SweepRange range{what, dt, least_speed};
  for (const Mover& mover : awake) sweep_standing(mover, range, found);
  if (what == Sweep::everything) {
    for (const Mover& mover : awake) sweep_ground(mover, range, found);
    sweep_movers(awake, range, found);
  }
  for (Contact& contact : found) put_lower_first(contact);
  mark_persistent(found);
  std::sort(found.begin(), found.end(), [](const Contact& a, const Contact& b) {
    if (a.time != b.time) return a.time < b.time;
    return before_by_parts(a, b);
  });
  return found;
}

namespace {

/// Where the ray enters the part, as a share of its way, and the outward normal there; in the solid's frame.
std::optional<std::pair<double, Vec3>> enter(const PartShape& part, const Vec3& from, const Vec3& way) {
  if (!part.polyhedron) {
    const Vec3 arm = from - part.centre;
    const double a = way.squaredNorm(), b = arm.dot(way), c = arm.squaredNorm() - part.radius * part.radius;
    const double root = b * b - a * c;
    if (root < 0 || c < 0) return std::nullopt;
    const double share = (-b - std::sqrt(root)) / a;
    if (share < 0 || share > 1) return std::nullopt;
    return std::pair(share, Vec3((arm + share * way) / part.radius));
  }
  double first = -1, last = 1;
  Vec3 normal = Vec3::Zero();
  for (const Polyhedron::Face& face : part.polyhedron->faces) {
    const double over = face.normal.dot(from) - face.offset, speed = face.normal.dot(way);
    if (speed == 0 && over > 0) return std::nullopt;
    if (speed == 0) continue;
    const double share = -over / speed;
    if (speed < 0 && share > first) first = share, normal = face.normal;
    if (speed > 0) last = std::min(last, share);
  }
  if (first < 0 || first > last) return std::nullopt;
  return std::pair(first, normal);
}

}  // namespace

std::optional<RayHit> DebrisWorld::ray_cast(const Vec3& from, const Vec3& to) const {
  const Vec3 way = to - from;
  double nearest = 2;
  std::uint64_t nearest_order = 0;
  std::optional<RayHit> hit;
  const auto take = [&](double share, std::uint64_t order, const Touched& what, const Vec3& normal) {
    if (share > nearest || (share == nearest && order > nearest_order)) return;
    nearest = share;
    nearest_order = order;
    hit = RayHit{what, from + share * way, normal, share * way.norm()};
  };
  const auto look_at = [&](std::uint32_t index) {
    const Collider& one = pairs_.collider(index);
    const btTransform at = transform_of(*one.solid);
    const SolidPart& part = one.solid->parts[static_cast<std::size_t>(one.part)];
    const Vec3 start = from_bullet(at.invXform(to_bullet(from)));
    const Mat3 turn = from_bullet(at.getBasis());
    if (const auto entered =
            enter(static_cast<const TouchingSolid*>(one.solid)->shapes[static_cast<std::size_t>(one.part)], start,
                  turn.transpose() * way))
      take(entered->first, one.order, touched(*one.solid, part.tag), turn * entered->second);
  };
  const Box3 box{from.cwiseMin(to), from.cwiseMax(to)};
  pairs_.each_in(box, true, look_at);
  pairs_.each_in(box, false, look_at);
  if (has_ground_ && from.z() > ground_height_ && to.z() <= ground_height_)
    take((ground_height_ - from.z()) / way.z(), std::numeric_limits<std::uint64_t>::max(), touched(ground_, -1),
         {0, 0, 1});
  return hit;
}

std::vector<ObstacleId> DebrisWorld::obstacles_in(const Vec3& low, const Vec3& high) const {
  std::vector<ObstacleId> result;
  pairs_.each_in({low, high}, true, [&](std::uint32_t index) { result.push_back({pairs_.collider(index).solid->id}); });
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

}  // namespace topple::collision
