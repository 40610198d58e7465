#include "debris/body_sweep.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <span>

#include "contacts/apart.h"
#include "contacts/moving_pairs.h"
#include "contacts/touch_contact.h"
#include "debris/motion_ahead.h"

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
void find_touches(const Mover& mover, const Met& met, double dt, double least_speed, std::vector<Contact>& found) {
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
    fast = fast || touch->approach_speed >= least_speed;
  };
  for (const auto& [j, other_bounds] : met.parts) {
    if (!other_bounds.meets(mover.whole)) continue;
    for (const auto& [i, bounds] : mover.parts) {
      if (!bounds.meets(other_bounds)) continue;
      const Meeting meeting =
          meeting_of({*mover.body, i, mover.motion, mover.end},
                     {static_cast<const TouchingSolid&>(other), j, other_motion, other_end}, dt, least_speed);
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
  BodySweep(const DebrisScene& scene, const IgnoredPairs& ignored, double dt, const SweepOptions& options);
  [[nodiscard]] std::vector<Mover> movers() const;
  void sweep_ground(const Mover& mover, std::vector<Contact>& found) const;
  void sweep_standing(const Mover& mover, std::vector<Contact>& found);
  void sweep_movers(const std::vector<Mover>& movers, std::vector<Contact>& found) const;

 private:
  [[nodiscard]] bool asked(BodyId id) const;
  [[nodiscard]] const Motion& obstacle_motion(const Solid& obstacle);
  void sweep_pair(const Mover& mover, const Met& other, std::vector<Contact>& found) const;

  const DebrisScene& scene_;
  const IgnoredPairs& ignored_;
  double dt_;
  const SweepOptions& options_;
  std::vector<const Collider*> asked_asleep_;  ///< parts of bodies that sleep and are asked for by name
  std::map<std::int64_t, Motion> obstacle_motions_;
  double obstacles_go_ = 0;  ///< m: how far one may be within the time from where its bounds are
};

BodySweep::BodySweep(const DebrisScene& scene, const IgnoredPairs& ignored, double dt, const SweepOptions& options)
    : scene_(scene), ignored_(ignored), dt_(dt), options_(options) {
  // The world has them where they were a part of a step ago; those that come near only now may be faster than it knows.
  if (options_.structure) {
    obstacles_go_ = scene_.settings.fat;
    for (const std::int64_t id : scene_.moving_obstacles)
      obstacles_go_ = std::max(obstacles_go_, 2 * dt_ * scene_.obstacle(id).speed());
  }
  if (options_.what == Sweep::obstacles || !options_.among || scene.all_awake()) return;
  for (const BodyId id : *options_.among) {
    const DebrisBody& one = scene_.body(id.value);
    if (!one.asleep) continue;
    for (const std::uint32_t index : one.colliders) asked_asleep_.push_back(&scene_.pairs.collider(index));
  }
}

bool BodySweep::asked(BodyId id) const {
  const auto& among = options_.among;
  return !among ||
         std::binary_search(among->begin(), among->end(), id, [](BodyId a, BodyId b) { return a.value < b.value; });
}

const Motion& BodySweep::obstacle_motion(const Solid& obstacle) {
  const auto [entry, made] = obstacle_motions_.try_emplace(obstacle.id);
  if (!made) return entry->second;
  Motion& motion = entry->second;
  motion.start = transform_of(obstacle);
  if (!options_.structure) return motion;
  if (const std::optional<ObstaclePath> path = options_.structure->path({obstacle.id}))
    motion = straight_on(obstacle, *path);
  return motion;
}

std::vector<Mover> BodySweep::movers() const {
  std::vector<Mover> result;
  for (const BodyId id : scene_.order) {
    const DebrisBody& one = scene_.body(id.value);
    if (one.asleep) continue;
    result.push_back(mover_of(one, motion_ahead(one, scene_.gravity, dt_), dt_));
    result.back().asked = asked(id);
  }
  return result;
}

void BodySweep::sweep_pair(const Mover& mover, const Met& met, std::vector<Contact>& found) const {
  const Solid& other = met.solid;
  const bool other_first = other.kind == Touched::Kind::body && other.id < mover.body->id;
  if (other_first ? ignored_.ignores(other, *mover.body) : ignored_.ignores(*mover.body, other)) return;
  // Slow meetings are told of what stands: who lies down on it is told from who strikes it by the caller.
  find_touches(mover, met, dt_, other.kind == Touched::Kind::body ? options_.least_speed : 0, found);
}

void BodySweep::sweep_ground(const Mover& mover, std::vector<Contact>& found) const {
  if (!mover.asked || !scene_.ground.there || mover.whole.low.z() > scene_.ground.height) return;
  if (fastest_closing(*mover.body, mover.motion, scene_.ground.solid, {}, dt_) < options_.least_speed) return;
  for (const auto& [i, bounds] : mover.parts) {
    if (bounds.low.z() > scene_.ground.height) continue;
    const SolidPart& part = mover.body->parts[i];
    const std::optional<Touch> touch = first_touch_of_ground(part, mover.motion, scene_.ground.height, dt_);
    if (touch) found.push_back(contact_of(*mover.body, part.tag, scene_.ground.solid, -1, *touch));
  }
}

void BodySweep::sweep_standing(const Mover& mover, std::vector<Contact>& found) {
  Box3 box = box_of(mover.whole);
  box.low.array() -= obstacles_go_;
  box.high.array() += obstacles_go_;
  std::vector<const Collider*> near;  // in order of solids, and of their parts
  const auto look_at = [&](const Collider& one) {
    if (one.fat.meets(box) && !DebrisScene::awake(*one.solid)) near.push_back(&one);
  };
  const auto take = [&](std::uint32_t index) { look_at(scene_.pairs.collider(index)); };
  scene_.pairs.each_in(box, true, take);
  if (options_.what == Sweep::everything && mover.asked && !scene_.all_awake()) scene_.pairs.each_in(box, false, take);
  if (!mover.asked)
    for (const Collider* one : asked_asleep_) look_at(*one);
  std::sort(near.begin(), near.end(), [](const Collider* a, const Collider* b) { return a->order < b->order; });
  for (std::size_t begin = 0, end = 0; begin < near.size(); begin = end) {
    const Solid& other = *near[begin]->solid;
    while (end < near.size() && near[end]->solid == &other) ++end;
    const bool is_body = other.kind == Touched::Kind::body;
    Motion still;
    still.start = transform_of(other);
    if (is_body && fastest_closing(*mover.body, mover.motion, other, still, dt_) < options_.least_speed) continue;
    const Motion& motion = is_body ? still : obstacle_motion(other);
    std::vector<SweptPart> parts;
    for (std::size_t i = begin; i < end; ++i) {
      const auto part = static_cast<std::size_t>(near[i]->part);
      parts.push_back({part, swept_bounds(other.parts[part], motion, dt_)});
    }
    sweep_pair(mover, {other, motion, parts}, found);
  }
}

void BodySweep::sweep_movers(const std::vector<Mover>& movers, std::vector<Contact>& found) const {
  const auto wanted = [](const Mover& first, const Mover& second) { return first.asked || second.asked; };
  const auto meet = [&](const Mover& first, const Mover& second) {
    sweep_pair(first, {*second.body, second.motion, second.parts}, found);
  };
  each_moving_pair(movers, dt_, options_.least_speed, wanted, meet);
}

}  // namespace

bool still_to_pass(const DebrisScene& scene, const DebrisBody& first, const Solid& other, double dt) {
  const double ahead = 2 * dt;
  const Motion other_motion = motion_ahead(other, scene.gravity, dt);
  const double resting_speed = 2 * scene.gravity.norm() * dt;
  std::vector<Contact> found;
  find_touches(mover_of(first, motion_ahead(first, scene.gravity, dt), ahead),
               {other, other_motion, swept_parts(other, other_motion, ahead)}, ahead, resting_speed, found);
  return std::any_of(found.begin(), found.end(),
                     [&](const Contact& contact) { return contact.approach_speed > resting_speed; });
}

std::vector<Contact> first_touches(const DebrisScene& scene, const IgnoredPairs& ignored, double dt,
                                   const SweepOptions& options) {
  BodySweep sweep(scene, ignored, dt, options);
  std::vector<Contact> found;
  const std::vector<Mover> awake = sweep.movers();
  for (const Mover& mover : awake) sweep.sweep_standing(mover, found);
  if (options.what == Sweep::everything) {
    for (const Mover& mover : awake) sweep.sweep_ground(mover, found);
    sweep.sweep_movers(awake, found);
  }
  for (Contact& contact : found) put_lower_first(contact);
  return found;
}

}  // namespace topple::collision
