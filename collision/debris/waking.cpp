#include "debris/waking.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace topple::collision {

/// A body that an awake one comes upon, before the step is solved: as a free body it takes the impact.
void Waking::wake_struck(double dt) {
  if (scene_.all_awake()) return;
  bool again = true;
  while (again) {
    again = false;
    std::vector<std::pair<DebrisBody*, double>> struck;
    for (const std::uint32_t index : scene_.touching) {
      const PairEnds& ends = scene_.pairs.ends(index);
      Solid *a = scene_.pairs.collider(ends.first).solid, *b = scene_.pairs.collider(ends.second).solid;
      if (a->kind != Touched::Kind::body || b->kind != Touched::Kind::body) continue;
      auto &first = static_cast<DebrisBody&>(*a), &second = static_cast<DebrisBody&>(*b);
      if (first.asleep == second.asleep) continue;
      const NearPair& pair = scene_.pairs.pair(index);
      const DebrisBody& moves = first.asleep ? second : first;
      const double side = first.asleep ? -1 : 1;
      const Vec3 velocity = moves.velocity + scene_.gravity * dt;
      double fastest = 0;
      for (int i = 0; i < pair.manifold.count; ++i) {
        const ManifoldPoint& point = pair.manifold.points[static_cast<std::size_t>(i)];
        const Vec3 arm = moves.at * (first.asleep ? point.on_second : point.on_first) - moves.at.position;
        const double approach = side * pair.manifold.normal.dot(velocity + moves.spin.cross(arm));
        if (approach > scene_.settings.struck_from + scene_.gravity.norm() * dt && point.separation < approach * dt)
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
    scene_.wake_hinged();
    search_.note_ways(dt);
    search_.seek_contacts(dt);
    search_.find_touching();
  }
}

/// As much of the heap as the impact's momentum would move at a noticeable speed.
void Waking::wake_round(DebrisBody& struck, double momentum) {
  std::vector<DebrisBody*> reached{&struck};
  double moved = 0;
  for (std::size_t i = 0; i < reached.size() && (i == 0 || moved * scene_.settings.struck_from < momentum); ++i) {
    moved += reached[i]->mass;
    scene_.wake_up(*reached[i]);
    for (const std::uint32_t index : scene_.touching) {
      const NearPair& pair = scene_.pairs.pair(index);
      Solid *a = scene_.pairs.collider(pair.first).solid, *b = scene_.pairs.collider(pair.second).solid;
      if (a != reached[i] && b != reached[i]) continue;
      Solid* other = a == reached[i] ? b : a;
      if (other->kind != Touched::Kind::body) continue;
      auto* next = static_cast<DebrisBody*>(other);
      if (next->asleep && std::find(reached.begin(), reached.end(), next) == reached.end()) reached.push_back(next);
    }
  }
}

/// What a body that sleeps is pressed with has changed: it may not rest any more. Forces are averaged over a time, so
/// that an impact counts by the speed that it would give and not by the length of the step.
void Waking::wake_changed(std::span<const Push> pushes, double dt) {
  if (scene_.all_awake()) return;
  const double weight = scene_.gravity.norm(), share = 1 - std::exp(-dt / scene_.settings.pressed_over);
  for (std::size_t i = 0; i < pushes.size(); ++i) {
    if (i + kAhead < pushes.size()) prefetch_lines(*pushes[i + kAhead].pair);
    NearPair& pair = *pushes[i].pair;
    const Vec3& impulse = pushes[i].impulse;
    pair.pressed += share * (impulse / dt - pair.pressed);
    for (const bool second : {false, true}) {
      Solid* solid = scene_.pairs.collider(second ? pair.second : pair.first).solid;
      if (solid->kind != Touched::Kind::body || !static_cast<DebrisBody*>(solid)->asleep) continue;
      auto& sleeps = static_cast<DebrisBody&>(*solid);
      if ((pair.pressed - pair.rest_force).norm() > scene_.settings.wakes_from * sleeps.mass * weight)
        scene_.wake_up(sleeps);
    }
  }
  // And what was pressed by one that has gone.
  const std::vector<std::uint32_t>& order = scene_.pairs.order();
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (i + 4 * kAhead < order.size()) __builtin_prefetch(&scene_.pairs.ends(order[i + 4 * kAhead]));
    const std::uint32_t index = order[i];
    if (!scene_.pairs.ends(index).rests || scene_.pairs.ends(index).touches) continue;
    NearPair& pair = scene_.pairs.pair(index);
    if (pair.rest_force.isZero(0) || !scene_.awake(pair)) continue;
    for (const std::uint32_t side : {pair.first, pair.second}) {
      Solid* solid = scene_.pairs.collider(side).solid;
      if (solid->kind == Touched::Kind::body) scene_.wake_up(static_cast<DebrisBody&>(*solid));
    }
    pair.rest_force.setZero();
    pair.pressed.setZero();
    scene_.pairs.ends(index).rests = false;
  }
}

}  // namespace topple::collision
