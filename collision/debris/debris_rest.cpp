#include "debris/debris_rest.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>

#include "bullet/bullet_types.h"

namespace topple::collision {

namespace {
/// A ball this near to its plumb line (m) may come to rest.
constexpr double plumb = 0.02;

/// True when no point of the boxes around its parts is farther than `far` from where it was then.
bool stayed(const DebrisBody& one, double far) {
  const Vec3 gone = one.at.position - one.position_then;
  if (gone.norm() + one.reach * one.turn.angularDistance(one.turn_then) <= far) return true;
  const Mat3 turned = one.turn.toRotationMatrix() - one.turn_then.toRotationMatrix();
  return std::all_of(one.parts.begin(), one.parts.end(), [&](const SolidPart& part) {
    const std::array<btVector3, 8> corners = corners_of_bounds(part);
    return std::all_of(corners.begin(), corners.end(), [&](const btVector3& corner) {
      return (gone + turned * from_bullet(corner)).squaredNorm() <= far * far;
    });
  });
}
}  // namespace

/// What is read at mid-step is at rest there with half a step of gravity less than none.
void DebrisRest::end_step(double dt) {
  for (const std::int64_t id : std::exchange(slept_now_, {}))
    if (DebrisBody* one = scene_.bodies[static_cast<std::size_t>(id)].get()) {
      one->wakes_with = -scene_.gravity * (dt / 2);
      one->wakes_spinning.setZero();
    }
}

bool DebrisRest::fall_asleep(std::span<Island> islands, double dt) {
  bool slept = false;
  for (Island& island : islands) {
    Island quiet = island.carried ? quiet_part(island) : island;
    slept = fall_asleep(quiet, dt) || slept;
  }
  return slept;
}

/// What has lain still in an island that something that moves carries in part, and does not touch that itself. A heap
/// against a building that sways so sleeps but for what is near it.
Island DebrisRest::quiet_part(const Island& island) const {
  std::set<const Solid*> stay;
  for (const DebrisBody* one : island.bodies)
    if (one->slow_for >= scene_.settings.slow_for - 1e-9) stay.insert(one);
  for (const std::uint32_t index : island.pairs)
    if (const PairEnds& ends = scene_.pairs.ends(index); moving_obstacle(scene_.pairs, ends))
      stay.erase(scene_.pairs.collider(ends.first).solid);
  for (const DebrisHinge* hinge : island.hinges)
    if (scene_.moving_holder(*hinge)) stay.erase(&scene_.body(hinge->body));
  for (bool again = true; again;) {  // what hangs together sleeps together
    again = false;
    for (const DebrisHinge* hinge : island.hinges) {
      if (hinge->other < 0) continue;
      const DebrisBody &one = scene_.body(hinge->body), &other = scene_.body(hinge->other);
      if (stay.contains(&one) != stay.contains(&other)) again = stay.erase(&one) + stay.erase(&other) > 0;
    }
  }
  Island quiet;
  for (DebrisBody* one : island.bodies)
    if (stay.contains(one)) quiet.bodies.push_back(one);
  for (const std::uint32_t index : island.pairs) {
    const NearPair& pair = scene_.pairs.pair(index);
    if (stay.contains(scene_.pairs.collider(pair.first).solid) ||
        stay.contains(scene_.pairs.collider(pair.second).solid))
      quiet.pairs.push_back(index);
  }
  for (DebrisHinge* hinge : island.hinges)
    if (stay.contains(&scene_.body(hinge->body))) quiet.hinges.push_back(hinge);
  for (DebrisCable* cable : island.cables)
    if (stay.contains(&scene_.body(cable->body))) quiet.cables.push_back(cable);
  return quiet;
}

/// Before the step is solved: an island all of whose bodies have been slow for some time stays where it is, if there
/// are forces that hold it; with it, what it lies on and sleeps already is asked, for these forces change. A few bodies
/// that no forces hold go on without it. True when any fell asleep.
bool DebrisRest::fall_asleep(Island& island, double dt) {
  if (island.bodies.empty()) return false;
  for (DebrisBody* one : island.bodies) {
    if (one->slow_for < scene_.settings.slow_for - 1e-9) return false;
    if (one->retry_rest > 0) return false;
  }
  Island whole = with_sleeping(island), outside = awake_on(whole);
  for (DebrisBody* one : whole.bodies) one->asleep = false;  // rows of what sleeps are rows, here
  Island* const only = &whole;
  solved_.fill(std::array{&whole, &outside}, dt, 0);
  std::vector<double> sizes{1};
  for (const DebrisBody* one : whole.bodies) sizes.push_back(one->reach);
  for (const DebrisBody* one : outside.bodies) sizes.push_back(one->reach);
  std::vector<char> moves(sizes.size(), 0);
  for (const DebrisBody* one : outside.bodies) moves[static_cast<std::size_t>(one->solver)] = 1;
  bool rests = solved_.solver().rest(dt, scene_.gravity, sizes, moves);
  for (std::size_t i = island.bodies.size(); i < whole.bodies.size(); ++i) {
    whole.bodies[i]->asleep = true;
    rests = rests && !moves[static_cast<std::size_t>(whole.bodies[i]->solver)];
  }
  const auto goes_on = [&](const DebrisBody& one) {
    return !rests || moves[static_cast<std::size_t>(one.solver)] != 0;
  };
  for (DebrisBody* one : island.bodies)
    if (goes_on(*one)) {
      one->retry_rest = one->rest_wait;
      one->rest_wait = std::min(2 * one->rest_wait, scene_.settings.rest_again_at_most);
    }
  if (!rests) return false;
  report_.add(solved_.solver().contacts(), dt, moves);
  for (const SolverContact& solved : solved_.solver().contacts())
    solved.pair->rest_force = solved.pair->pressed = solved.impulse / dt;
  for (const std::uint32_t index : whole.pairs) scene_.pairs.ends(index).rests = true;
  for (DebrisHinge* hinge : whole.hinges) hinge->forget_step();
  for (DebrisCable* cable : whole.cables) cable->pull = {};
  solved_.read_joints({&only, 1}, dt);
  for (DebrisBody* one : island.bodies) {
    if (goes_on(*one)) continue;
    slept_now_.push_back(one->id);
    scene_.fall_asleep(*one);
    one->velocity.setZero();
    one->spin.setZero();
  }
  return true;
}

/// The island, and all bodies that sleep and touch it or hang on it, or on what does.
Island DebrisRest::with_sleeping(const Island& island) const {
  Island whole = island;
  std::set<const Solid*> known(whole.bodies.begin(), whole.bodies.end());
  std::set<std::uint32_t> pairs(whole.pairs.begin(), whole.pairs.end());
  const auto sleeping = [&](std::uint32_t collider) -> DebrisBody* {
    Solid* solid = scene_.pairs.collider(collider).solid;
    if (solid->kind != Touched::Kind::body) return nullptr;
    auto* one = static_cast<DebrisBody*>(solid);
    return one->asleep ? one : nullptr;
  };
  for (bool grows = true; grows;) {
    grows = false;
    for (const auto& [id, hinge] : scene_.hinges) {
      if (hinge->other < 0) continue;
      DebrisBody &one = scene_.body(hinge->body), &other = scene_.body(hinge->other);
      if (known.contains(&one) == known.contains(&other)) continue;
      DebrisBody& next = known.contains(&one) ? other : one;
      known.insert(&next);
      whole.bodies.push_back(&next);
      grows = true;
    }
    for (const std::uint32_t index : scene_.touching) {
      const NearPair& pair = scene_.pairs.pair(index);
      DebrisBody *a = sleeping(pair.first), *b = sleeping(pair.second);
      const bool first = known.contains(scene_.pairs.collider(pair.first).solid),
                 second = known.contains(scene_.pairs.collider(pair.second).solid);
      if (!first && !second) continue;
      for (DebrisBody* next : {first ? nullptr : a, second ? nullptr : b})
        if (next && known.insert(next).second) {
          whole.bodies.push_back(next);
          grows = true;
        }
      if (pairs.insert(index).second) whole.pairs.push_back(index);
    }
  }
  for (std::size_t i = island.bodies.size(); i < whole.bodies.size(); ++i) {
    for (const std::int64_t id : whole.bodies[i]->hinges)
      if (scene_.hinge(id).body == whole.bodies[i]->id) whole.hinges.push_back(&scene_.hinge(id));
    for (const std::int64_t id : whole.bodies[i]->cables) whole.cables.push_back(&scene_.cable(id));
  }
  std::sort(whole.pairs.begin(), whole.pairs.end(),
            [&](std::uint32_t a, std::uint32_t b) { return scene_.pairs.in_order(a, b); });
  return whole;
}

/// Bodies of other islands that lie on what sleeps: they are awake, and press with the forces of the last step.
Island DebrisRest::awake_on(const Island& whole) const {
  const std::set<const Solid*> known(whole.bodies.begin(), whole.bodies.end());
  Island outside;
  for (const std::uint32_t index : whole.pairs)
    for (const std::uint32_t side : {scene_.pairs.pair(index).first, scene_.pairs.pair(index).second}) {
      Solid* solid = scene_.pairs.collider(side).solid;
      if (solid->kind != Touched::Kind::body || known.contains(solid)) continue;
      auto* one = static_cast<DebrisBody*>(solid);
      if (std::find(outside.bodies.begin(), outside.bodies.end(), one) == outside.bodies.end())
        outside.bodies.push_back(one);
    }
  return outside;
}

/// How long each body has stayed where it is. What rocks to and fro by less than that is slow as well, and what creeps
/// by less in each `slow_for`; where something that moves carries some of an island, only what stays as near as points
/// touch.
void DebrisRest::watch(std::span<const Island> islands, double dt) {
  for (const Island& island : islands) {
    const double far = island.carried ? scene_.settings.touching : scene_.settings.slow * scene_.settings.slow_for;
    for (DebrisBody* one : island.bodies) {
      if (one->asleep) continue;
      const bool held = !island.pairs.empty() || !island.hinges.empty() || !island.cables.empty();
      const bool slow = held && stayed(*one, far) && !swings(*one);
      if (!slow) {
        one->slow_for = 0;
        one->rest_wait = scene_.settings.rest_again;
      }
      const auto windows = [&] { return std::floor(one->slow_for / scene_.settings.slow_for + 1e-9); };
      const double before = windows();
      one->slow_for += dt;
      if (!slow || windows() != before) {
        one->position_then = one->at.position;
        one->turn_then = one->turn;
      }
      one->retry_rest = std::max(0.0, one->retry_rest - dt);
    }
  }
}

/// A ball at the end of its swing is slow and seems to go nowhere, but does not rest.
bool DebrisRest::swings(const DebrisBody& one) const {
  if (one.cables.empty()) return false;
  const bool touches = std::any_of(report_.all().begin(), report_.all().end(), [&](const Contact& contact) {
    return contact.body.value == one.id || contact.other.body.value == one.id;
  });
  if (touches) return false;
  const Vec3 down = scene_.gravity.isZero(0) ? Vec3(0, 0, -1) : Vec3(scene_.gravity.normalized());
  return std::any_of(one.cables.begin(), one.cables.end(), [&](std::int64_t id) {
    const Vec3 arm = one.at.position - scene_.cable(id).row.anchor;
    return (arm - down * down.dot(arm)).norm() > plumb;
  });
}

}  // namespace topple::collision
