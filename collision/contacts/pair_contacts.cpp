#include "contacts/pair_contacts.h"

#include <algorithm>
#include <cmath>

#include "contacts/part_contacts.h"

namespace topple::collision {

namespace {

/// No point of the second has moved farther in the first's frame since contacts were sought.
double moved(const NearPair& pair, const Mat3& turn, const Vec3& shift, double reach) {
  const double turned = (turn - pair.turn).norm() / std::sqrt(2.0);  // the largest change of a unit vector, at most
  return (shift - pair.shift).norm() + reach * turned;
}

void carry(NearPair& pair, const PairMotion& motion) {
  Manifold& manifold = pair.manifold;
  const Placement &first = *motion.first_at, &second = *motion.second_at;
  manifold.normal = (manifold.normal_on_first ? first : second).turn * manifold.local_normal;
  for (int i = 0; i < manifold.count; ++i) {
    ManifoldPoint& point = manifold.points[static_cast<std::size_t>(i)];
    point.separation = manifold.normal.dot(second * point.on_second - first * point.on_first);
  }
}

/// The sum of the impulses stays: what finds no new point near it is shared by those that found no old one.
void inherit_impulses(const Manifold& old, Manifold& now, double matched) {
  std::array<bool, Manifold::most> taken{};
  std::array<bool, Manifold::most> found{};
  double left = 0, left_force = 0;
  for (int k = 0; k < old.count; ++k) {
    const ManifoldPoint& before = old.points[static_cast<std::size_t>(k)];
    int nearest = -1;
    double least = matched * matched;
    for (int i = 0; i < now.count; ++i) {
      if (taken[static_cast<std::size_t>(i)]) continue;
      const ManifoldPoint& point = now.points[static_cast<std::size_t>(i)];
      const double away = std::min((point.on_first - before.on_first).squaredNorm(),
                                   (point.on_second - before.on_second).squaredNorm());
      if (away < least) least = away, nearest = i;
    }
    if (nearest < 0) {
      left += before.impulse;
      left_force += before.force;
      continue;
    }
    taken[static_cast<std::size_t>(nearest)] = found[static_cast<std::size_t>(nearest)] = true;
    now.points[static_cast<std::size_t>(nearest)].impulse = before.impulse;
    now.points[static_cast<std::size_t>(nearest)].force = before.force;
  }
  const auto unmatched = std::count(found.begin(), found.begin() + now.count, false);
  for (int i = 0; i < now.count && unmatched > 0; ++i) {
    if (found[static_cast<std::size_t>(i)]) continue;
    ManifoldPoint& point = now.points[static_cast<std::size_t>(i)];
    point.impulse = left / static_cast<double>(unmatched);
    point.force = left_force / static_cast<double>(unmatched);
  }
  now.friction = old.friction;
  now.twist = old.twist;
  now.friction_force = old.friction_force;
  now.twist_force = old.twist_force;
}

}  // namespace

double update_contacts(NearPair& pair, const PairMotion& motion, double kept, double matched) {
  const Placement &first = *motion.first_at, &second = *motion.second_at;
  if (motion.second == nullptr) {
    const Manifold old = pair.manifold;
    collide_with_ground(*motion.first, first, motion.ground_height, motion.margin, pair.manifold);
    inherit_impulses(old, pair.manifold, matched);
    return 0;
  }
  const Mat3 turn = first.turn.transpose() * second.turn;
  const Vec3 shift = first.turn.transpose() * (second.position - first.position);
  if (pair.sought && motion.first->polyhedron && motion.second->polyhedron) {
    const double away = moved(pair, turn, shift, motion.second->polyhedron->reach);
    if (pair.clear > 0 && away + motion.margin < pair.clear) return pair.clear - away;
    if (pair.clear <= 0 && away <= kept && motion.margin <= pair.margin + kept) {
      carry(pair, motion);
      // What goes past an edge meanwhile comes through the plane that it had: nothing begins to push by that.
      if (pair.manifold.nearest() > 0 || pair.manifold.bears()) return 0;
    }
  }
  const Manifold old = pair.manifold;
  collide(*motion.first, first, *motion.second, second, motion.margin, pair.axis, pair.manifold);
  inherit_impulses(old, pair.manifold, matched);
  pair.sought = true;
  pair.turn = turn;
  pair.shift = shift;
  pair.margin = motion.margin;
  // What the axis proves. Faces may have no point within the margin, and the two be nearer than it all the same.
  pair.clear = pair.manifold.count > 0 ? -1 : pair.axis.gap;
  return motion.first->polyhedron && motion.second->polyhedron ? std::max(0.0, pair.clear) : 0;
}

}  // namespace topple::collision
