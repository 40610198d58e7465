#include "debris/body_sweep.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "contacts/apart.h"
#include "contacts/moving_pairs.h"
#include "contacts/touch_contact.h"

namespace topple::collision {

namespace {

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

Box3 box_of(const Bounds& bounds) { return {from_bullet(bounds.low), from_bullet(bounds.high)}; }

struct Mover {
  const DebrisBody* body = nullptr;
  bool asked = true;  ///< all that it meets is asked for; of others, what meets one that is
  Motion motion;
  Placement end;
  std::vector<SweptPart> parts;  ///< all
  Bounds whole;
};

/// What a mover may meet: a solid with its motion, and those of its parts that are near.
struct Met {
  const Solid& solid;
  const Motion& motion;
  std::span<const SweptPart> parts;
};

Motion motion_of(const DebrisBody& body, const Vec3& gravity, double dt) {
  Motion motion;
  motion.start = transform_of(body);
  if (!body.asleep) {
    // What lies is borne in this step as in the last: it does not fall upon what is near. What was struck falls on.
    const bool struck = body.acceleration.squaredNorm() > gravity.squaredNorm();
    const Vec3 acceleration = struck ? gravity : body.acceleration;
    motion.acceleration = to_bullet(acceleration);
    // Stored velocities are those of mid-step; they came from the middle of the last sub-step.
    const double substep = body.substep_rate > 0 ? 1 / body.substep_rate : 0;
    motion.velocity = to_bullet(body.velocity + gravity * (dt / 2) + (acceleration - gravity) * (substep / 2));
  }
  motion.angular_velocity = to_bullet(body.spin);
  return motion;
}

Mover mover_of(const DebrisBody& body, const Motion& motion, double duration) {
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

/// Of each part of the one with each part of the other. What meets slowly matters beside what meets fast alone: a body
/// that comes down on several places at once.
void find_touches(const Mover& mover, const Met& met, const SweepRange& range, std::vector<Contact>& found) {
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

/// Awake bodies against what stands, what sleeps, the ground and each other.
class BodySweep {
 public:
  BodySweep(const DebrisScene& scene, const IgnoredPairs& ignored, const SweepRange& range);
  [[nodiscard]] std::vector<Mover> movers(double dt) const;
  void sweep_ground(const Mover& mover, const SweepRange& range, std::vector<Contact>& found) const;
  void sweep_standing(const Mover& mover, const SweepRange& range, std::vector<Contact>& found) const;
  void sweep_movers(const std::vector<Mover>& movers, const SweepRange& range, std::vector<Contact>& found) const;

 private:
  [[nodiscard]] bool asked(BodyId id) const;
  void sweep_pair(const Mover& mover, const Met& other, const SweepRange& range, std::vector<Contact>& found) const;

  const DebrisScene& scene_;
  const IgnoredPairs& ignored_;
  std::optional<std::span<const BodyId>> among_;
  std::vector<const Collider*> asked_asleep_;  ///< parts of bodies that sleep and are asked for by name
};

BodySweep::BodySweep(const DebrisScene& scene, const IgnoredPairs& ignored, const SweepRange& range)
    : scene_(scene), ignored_(ignored), among_(range.among) {
  if (range.what == Sweep::obstacles || !among_ || scene.all_awake()) return;
  for (const BodyId id : *among_) {
    const DebrisBody& one = scene.body(id.value);
    if (!one.asleep) continue;
    for (const std::uint32_t index : one.colliders) asked_asleep_.push_back(&scene.pairs.collider(index));
  }
}

bool BodySweep::asked(BodyId id) const {
  return !among_ ||
         std::binary_search(among_->begin(), among_->end(), id, [](BodyId a, BodyId b) { return a.value < b.value; });
}

std::vector<Mover> BodySweep::movers(double dt) const {
  std::vector<Mover> result;
  for (const BodyId id : scene_.order) {
    const DebrisBody& one = scene_.body(id.value);
    if (one.asleep) continue;
    result.push_back(mover_of(one, motion_of(one, scene_.gravity, dt), dt));
    result.back().asked = asked(id);
  }
  return result;
}

void BodySweep::sweep_pair(const Mover& mover, const Met& met, const SweepRange& range,
                           std::vector<Contact>& found) const {
  const Solid& other = met.solid;
  const bool other_first = other.kind == Touched::Kind::body && other.id < mover.body->id;
  if (other_first ? ignored_.ignores(other, *mover.body) : ignored_.ignores(*mover.body, other)) return;
  // Slow meetings are told of what stands: who lies down on it is told from who strikes it by the caller.
  const double least = other.kind == Touched::Kind::body ? range.least_speed : 0;
  find_touches(mover, met, {range.what, range.dt, least}, found);
}

void BodySweep::sweep_ground(const Mover& mover, const SweepRange& range, std::vector<Contact>& found) const {
  if (!mover.asked || !scene_.ground.there || mover.whole.low.z() > scene_.ground.height) return;
  const double dt = range.dt;
  if (fastest_closing(*mover.body, mover.motion, scene_.ground.solid, {}, dt) < range.least_speed) return;
  for (const auto& [i, bounds] : mover.parts) {
    if (bounds.low.z() > scene_.ground.height) continue;
    const SolidPart& part = mover.body->parts[i];
    const std::optional<Touch> touch = first_touch_of_ground(part, mover.motion, scene_.ground.height, dt);
    if (touch) found.push_back(contact_of(*mover.body, part.tag, scene_.ground.solid, -1, *touch));
  }
}

void BodySweep::sweep_standing(const Mover& mover, const SweepRange& range, std::vector<Contact>& found) const {
  const auto [what, dt, least_speed, among] = range;
  const Box3 box = box_of(mover.whole);
  std::vector<const Collider*> near;  // in order of solids, and of their parts
  const auto look_at = [&](const Collider& one) {
    if (one.fat.meets(box) && !DebrisScene::awake(*one.solid)) near.push_back(&one);
  };
  const auto take = [&](std::uint32_t index) { look_at(scene_.pairs.collider(index)); };
  scene_.pairs.each_in(box, true, take);
  if (what == Sweep::everything && mover.asked && !scene_.all_awake()) scene_.pairs.each_in(box, false, take);
  if (!mover.asked)
    for (const Collider* one : asked_asleep_) look_at(*one);
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

void BodySweep::sweep_movers(const std::vector<Mover>& movers, const SweepRange& range,
                             std::vector<Contact>& found) const {
  const auto wanted = [](const Mover& first, const Mover& second) { return first.asked || second.asked; };
  const auto meet = [&](const Mover& first, const Mover& second) {
    sweep_pair(first, {*second.body, second.motion, second.parts}, range, found);
  };
  each_moving_pair(movers, range.dt, range.least_speed, wanted, meet);
}

}  // namespace

bool still_to_pass(const DebrisScene& scene, const DebrisBody& first, const Solid& other, bool other_moves, double dt) {
  const double ahead = 2 * dt;
  Motion other_motion;
  other_motion.start = transform_of(other);
  if (other_moves) other_motion = motion_of(static_cast<const DebrisBody&>(other), scene.gravity, dt);
  const double resting_speed = 2 * scene.gravity.norm() * dt;
  std::vector<Contact> found;
  find_touches(mover_of(first, motion_of(first, scene.gravity, dt), ahead),
               {other, other_motion, swept_parts(other, other_motion, ahead)},
               {Sweep::everything, ahead, resting_speed}, found);
  return std::any_of(found.begin(), found.end(),
                     [&](const Contact& contact) { return contact.approach_speed > resting_speed; });
}

std::vector<Contact> first_touches(const DebrisScene& scene, const IgnoredPairs& ignored, const SweepRange& range) {
  const BodySweep sweep(scene, ignored, range);
  std::vector<Contact> found;
  const std::vector<Mover> awake = sweep.movers(range.dt);
  for (const Mover& mover : awake) sweep.sweep_standing(mover, range, found);
  if (range.what == Sweep::everything) {
    for (const Mover& mover : awake) sweep.sweep_ground(mover, range, found);
    sweep.sweep_movers(awake, range, found);
  }
  for (Contact& contact : found) put_lower_first(contact);
  return found;
}

}  // namespace topple::collision
