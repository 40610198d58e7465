// Rest.
#include <algorithm>
#include <array>
#include <cmath>

#include "debris/debris_world.h"

namespace topple::collision {

/// What has lain still in an island that something that moves carries in part, and does not touch that itself. A heap
/// against a building that sways so sleeps but for what is near it.
Island DebrisWorld::quiet_part(const Island& island) const {
  std::set<const Solid*> stay;
  for (const DebrisBody* one : island.bodies)
    if (one->slow_for >= settings_.slow_for - 1e-9) stay.insert(one);
  for (const std::uint32_t index : island.pairs)
    if (const PairEnds& ends = pairs_.ends(index); moving_obstacle(pairs_, ends))
      stay.erase(pairs_.collider(ends.first).solid);
  for (bool again = true; again;) {  // what hangs together sleeps together
    again = false;
    for (const DebrisHinge* hinge : island.hinges) {
      if (hinge->other < 0) continue;
      const DebrisBody &one = body(hinge->body), &other = body(hinge->other);
      if (stay.contains(&one) != stay.contains(&other)) again = stay.erase(&one) + stay.erase(&other) > 0;
    }
  }
  Island quiet;
  for (DebrisBody* one : island.bodies)
    if (stay.contains(one)) quiet.bodies.push_back(one);
  for (const std::uint32_t index : island.pairs) {
    const NearPair& pair = pairs_.pair(index);
    if (stay.contains(pairs_.collider(pair.first).solid) || stay.contains(pairs_.collider(pair.second).solid))
      quiet.pairs.push_back(index);
  }
  for (DebrisHinge* hinge : island.hinges)
    if (stay.contains(&body(hinge->body))) quiet.hinges.push_back(hinge);
  for (DebrisCable* cable : island.cables)
    if (stay.contains(&body(cable->body))) quiet.cables.push_back(cable);
  return quiet;
}

/// Before the step is solved: an island all of whose bodies have been slow for some time stays where it is, if there
/// are forces that hold it; with it, what it lies on and sleeps already is asked, for these forces change. A few bodies
/// that no forces hold go on without it. True when any fell asleep.
bool DebrisWorld::come_to_rest(Island& island, double dt) {
  if (island.bodies.empty()) return false;
  for (DebrisBody* one : island.bodies) {
    if (one->slow_for < settings_.slow_for - 1e-9) return false;
    if (one->retry_rest > 0) return false;
  }
  Island whole = with_sleeping(island), outside = awake_on(whole);
  for (DebrisBody* one : whole.bodies) one->asleep = false;  // rows of what sleeps are rows, here
  Island* const only = &whole;
  fill_solver(std::array{&whole, &outside}, dt, 0);
  std::vector<double> sizes{1};
  for (const DebrisBody* one : whole.bodies) sizes.push_back(one->reach);
  for (const DebrisBody* one : outside.bodies) sizes.push_back(one->reach);
  std::vector<char> moves(sizes.size(), 0);
  for (const DebrisBody* one : outside.bodies) moves[static_cast<std::size_t>(one->solver)] = 1;
  bool rests = solver_.rest(dt, gravity_, sizes, moves);
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
      one->rest_wait = std::min(2 * one->rest_wait, settings_.rest_again_at_most);
    }
  if (!rests) return false;
  tell_contacts(dt, moves);
  for (const SolverContact& solved : solver_.contacts())
    solved.pair->rest_force = solved.pair->pressed = solved.impulse / dt;
  for (const std::uint32_t index : whole.pairs) pairs_.ends(index).rests = true;
  for (DebrisHinge* hinge : whole.hinges) hinge->forget_step();
  for (DebrisCable* cable : whole.cables) cable->pull = {};
  read_joints({&only, 1}, dt);
  for (DebrisBody* one : island.bodies) {
    if (goes_on(*one)) continue;
    one->slept_now = true;
    slept_now_.push_back(one->id);
    one->velocity.setZero();
    one->spin.setZero();
    one->asleep = true;
    --awake_count_;
  }
  return true;
}

/// The island, and all bodies that sleep and touch it or hang on it, or on what does.
Island DebrisWorld::with_sleeping(const Island& island) const {
  Island whole = island;
  std::set<const Solid*> known(whole.bodies.begin(), whole.bodies.end());
  std::set<std::uint32_t> pairs(whole.pairs.begin(), whole.pairs.end());
  const auto sleeping = [&](std::uint32_t collider) -> DebrisBody* {
    Solid* solid = pairs_.collider(collider).solid;
    if (solid->kind != Touched::Kind::body) return nullptr;
    auto* one = static_cast<DebrisBody*>(solid);
    return one->asleep ? one : nullptr;
  };
  for (bool grows = true; grows;) {
    grows = false;
    for (const auto& [id, hinge] : hinges_) {
      if (hinge->other < 0) continue;
      DebrisBody &one = body(hinge->body), &other = body(hinge->other);
      if (known.contains(&one) == known.contains(&other)) continue;
      DebrisBody& next = known.contains(&one) ? other : one;
      known.insert(&next);
      whole.bodies.push_back(&next);
      grows = true;
    }
    for (const std::uint32_t index : touching_) {
      const NearPair& pair = pairs_.pair(index);
      DebrisBody *a = sleeping(pair.first), *b = sleeping(pair.second);
      const bool first = known.contains(pairs_.collider(pair.first).solid),
                 second = known.contains(pairs_.collider(pair.second).solid);
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
      if (hinge(id).body == whole.bodies[i]->id) whole.hinges.push_back(&hinge(id));
    for (const std::int64_t id : whole.bodies[i]->cables) whole.cables.push_back(&cable(id));
  }
  std::sort(whole.pairs.begin(), whole.pairs.end(),
            [&](std::uint32_t a, std::uint32_t b) { return pairs_.in_order(a, b); });
  return whole;
}

/// Bodies of other islands that lie on what sleeps: they are awake, and press with the forces of the last step.
Island DebrisWorld::awake_on(const Island& whole) const {
  const std::set<const Solid*> known(whole.bodies.begin(), whole.bodies.end());
  Island outside;
  for (const std::uint32_t index : whole.pairs)
    for (const std::uint32_t side : {pairs_.pair(index).first, pairs_.pair(index).second}) {
      Solid* solid = pairs_.collider(side).solid;
      if (solid->kind != Touched::Kind::body || known.contains(solid)) continue;
      auto* one = static_cast<DebrisBody*>(solid);
      if (std::find(outside.bodies.begin(), outside.bodies.end(), one) == outside.bodies.end())
        outside.bodies.push_back(one);
    }
  return outside;
}

/// A body that an awake one comes upon, before the step is solved: as a free body it takes the blow.
void DebrisWorld::wake_struck(double dt) {
  if (awake_count_ == order_.size()) return;
  bool again = true;
  while (again) {
    again = false;
    std::vector<std::pair<DebrisBody*, double>> struck;
    for (const std::uint32_t index : touching_) {
      const PairEnds& ends = pairs_.ends(index);
      Solid *a = pairs_.collider(ends.first).solid, *b = pairs_.collider(ends.second).solid;
      if (a->kind != Touched::Kind::body || b->kind != Touched::Kind::body) continue;
      auto &first = static_cast<DebrisBody&>(*a), &second = static_cast<DebrisBody&>(*b);
      if (first.asleep == second.asleep) continue;
      const NearPair& pair = pairs_.pair(index);
      const DebrisBody& moves = first.asleep ? second : first;
      const double side = first.asleep ? -1 : 1;
      const Vec3 velocity = moves.velocity + gravity_ * dt;
      double fastest = 0;
      for (int i = 0; i < pair.manifold.count; ++i) {
        const ManifoldPoint& point = pair.manifold.points[static_cast<std::size_t>(i)];
        const Vec3 arm = moves.at * (first.asleep ? point.on_second : point.on_first) - moves.at.position;
        const double approach = side * pair.manifold.normal.dot(velocity + moves.spin.cross(arm));
        if (approach > settings_.struck_from + gravity_.norm() * dt && point.separation < approach * dt)
          fastest = std::max(fastest, approach);
      }
      if (fastest > 0) struck.emplace_back(&(first.asleep ? first : second), fastest * moves.mass);
    }
    for (const auto& [one, momentum] : struck)
      if (one->asleep) {
        wake_round(*one, momentum);
        again = true;
      }
    if (!again) break;
    wake_hinged();
    note_ways(dt);
    seek_contacts();
    find_touching();
  }
}

/// What hangs together is awake together.
void DebrisWorld::wake_hinged() {
  for (bool again = true; again;) {
    again = false;
    for (auto& [id, hinge] : hinges_) {
      if (hinge->other < 0) continue;
      DebrisBody &one = body(hinge->body), &other = body(hinge->other);
      if (one.asleep == other.asleep) continue;
      wake_up(one.asleep ? one : other);
      again = true;
    }
  }
}

/// As much of the heap as the blow's momentum would move at a noticeable speed.
void DebrisWorld::wake_round(DebrisBody& struck, double momentum) {
  std::vector<DebrisBody*> reached{&struck};
  double moved = 0;
  for (std::size_t i = 0; i < reached.size() && (i == 0 || moved * settings_.struck_from < momentum); ++i) {
    moved += reached[i]->mass;
    wake_up(*reached[i]);
    for (const std::uint32_t index : touching_) {
      const NearPair& pair = pairs_.pair(index);
      Solid *a = pairs_.collider(pair.first).solid, *b = pairs_.collider(pair.second).solid;
      if (a != reached[i] && b != reached[i]) continue;
      Solid* other = a == reached[i] ? b : a;
      if (other->kind != Touched::Kind::body) continue;
      auto* next = static_cast<DebrisBody*>(other);
      if (next->asleep && std::find(reached.begin(), reached.end(), next) == reached.end()) reached.push_back(next);
    }
  }
}

/// What a body that sleeps is pressed with has changed: it may not rest any more. Forces are averaged over a time, so
/// that a blow counts by the speed that it would give and not by the length of the step.
void DebrisWorld::wake_changed(double dt) {
  if (awake_count_ == order_.size()) return;
  const double weight = gravity_.norm(), share = 1 - std::exp(-dt / settings_.pressed_over);
  for (const auto& [solved, impulse] : impulses_) {
    NearPair& pair = *solved;
    pair.pressed += share * (impulse / dt - pair.pressed);
    for (const bool second : {false, true}) {
      Solid* solid = pairs_.collider(second ? pair.second : pair.first).solid;
      if (solid->kind != Touched::Kind::body || !static_cast<DebrisBody*>(solid)->asleep) continue;
      auto& sleeps = static_cast<DebrisBody&>(*solid);
      if ((pair.pressed - pair.rest_force).norm() > settings_.wakes_from * sleeps.mass * weight) wake_up(sleeps);
    }
  }
  // And what was pressed by one that has gone.
  for (const std::uint32_t index : pairs_.order()) {
    if (!pairs_.ends(index).rests || pairs_.ends(index).touches) continue;
    NearPair& pair = pairs_.pair(index);
    if (pair.rest_force.isZero(0) || !awake(pair)) continue;
    for (const std::uint32_t side : {pair.first, pair.second}) {
      Solid* solid = pairs_.collider(side).solid;
      if (solid->kind == Touched::Kind::body) wake_up(static_cast<DebrisBody&>(*solid));
    }
    pair.rest_force.setZero();
    pair.pressed.setZero();
    pairs_.ends(index).rests = false;
  }
}

/// How long each body has stayed where it is. What rocks to and fro by less than that is slow as well; where something
/// that moves carries some of an island, only what stays as near as points touch.
void DebrisWorld::look_for_rest(double dt) {
  for (const Island& island : islands_) {
    const double far = island.carried ? settings_.touching : settings_.slow * settings_.slow_for;
    for (DebrisBody* one : island.bodies) {
      if (one->asleep) continue;
      const bool held = !island.pairs.empty() || !island.hinges.empty() || !island.cables.empty();
      const double turned = one->reach * one->turn.angularDistance(one->turn_then);
      if (!held || (one->at.position - one->position_then).norm() + turned > far || swings(*one)) {
        one->slow_for = 0;
        one->rest_wait = settings_.rest_again;
        one->position_then = one->at.position;
        one->turn_then = one->turn;
      }
      one->slow_for += dt;
      one->retry_rest = std::max(0.0, one->retry_rest - dt);
    }
  }
}

}  // namespace topple::collision
