#include "debris/islands.h"

#include <algorithm>
#include <numeric>

namespace topple::collision {
namespace {

/// Sets of numbers that are joined two by two; the least of a set stands for it.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0); }
  int root(int i) {
    while (parent_[static_cast<std::size_t>(i)] != i)
      i = parent_[static_cast<std::size_t>(i)] =
          parent_[static_cast<std::size_t>(parent_[static_cast<std::size_t>(i)])];
    return i;
  }
  void join(int a, int b) {
    const int first = root(a), second = root(b);
    parent_[static_cast<std::size_t>(std::max(first, second))] = std::min(first, second);
  }

 private:
  std::vector<int> parent_;
};

DebrisBody* awake_body(const NearPairs& pairs, std::uint32_t collider) {
  Solid* const solid = pairs.collider(collider).solid;
  if (solid->kind != Touched::Kind::body) return nullptr;
  auto* const one = static_cast<DebrisBody*>(solid);
  return one->asleep ? nullptr : one;
}

void join_by(DebrisObstacle& carrier, const DebrisBody& body, DisjointSets& sets) {
  if (carrier.island < 0)
    carrier.island = body.island;
  else
    sets.join(body.island, carrier.island);
}

void join_touching(const IslandParts& parts, DisjointSets& sets) {
  for (const std::uint32_t index : parts.touching) {
    const PairEnds& ends = parts.pairs.ends(index);
    const DebrisBody *a = awake_body(parts.pairs, ends.first), *b = awake_body(parts.pairs, ends.second);
    if (a && b) sets.join(a->island, b->island);
    Solid* const second = parts.pairs.collider(ends.second).solid;
    if (!a || second->kind != Touched::Kind::obstacle) continue;
    auto* const carrier = static_cast<DebrisObstacle*>(second);
    if (carrier->moves) join_by(*carrier, *a, sets);
  }
}

/// With their bodies alone.
std::vector<Island> number(std::span<DebrisBody* const> awake, DisjointSets& sets) {
  std::vector<int> numbers(awake.size(), -1);
  std::vector<Island> islands;
  for (DebrisBody* one : awake) {
    const auto top = static_cast<std::size_t>(sets.root(one->island));
    if (numbers[top] < 0) {
      numbers[top] = static_cast<int>(islands.size());
      islands.emplace_back();
    }
    one->island = numbers[top];
    Island& island = islands[static_cast<std::size_t>(one->island)];
    island.bodies.push_back(one);
    island.load = std::max(island.load, one->load);
    island.substep_rate = std::max(island.substep_rate, one->substep_rate);
  }
  return islands;
}

}  // namespace

std::vector<Island> find_islands(const IslandParts& parts) {
  for (std::size_t i = 0; i < parts.awake.size(); ++i) parts.awake[i]->island = static_cast<int>(i);
  DisjointSets sets(parts.awake.size());
  join_touching(parts, sets);
  for (const IslandParts::Hung& hung : parts.hinges) {
    if (hung.other) sets.join(hung.body->island, hung.other->island);
    if (hung.carrier) join_by(*hung.carrier, *hung.body, sets);
  }
  std::vector<Island> islands = number(parts.awake, sets);
  const auto of = [&](const DebrisBody& one) -> Island& { return islands[static_cast<std::size_t>(one.island)]; };
  for (const std::uint32_t index : parts.touching) {
    const PairEnds& ends = parts.pairs.ends(index);
    const DebrisBody *a = awake_body(parts.pairs, ends.first), *b = awake_body(parts.pairs, ends.second);
    if (!a && !b) continue;
    Island& island = of(a ? *a : *b);
    island.pairs.push_back(index);
    if (const DebrisObstacle* carrier = moving_obstacle(parts.pairs, ends))
      island.carried = island.carried || carrier->speed() > parts.carries_from;
  }
  for (const IslandParts::Hung& hung : parts.hinges) {
    Island& island = of(*hung.body);
    island.hinges.push_back(hung.hinge);
    if (hung.carrier) island.carried = island.carried || hung.carrier->speed() > parts.carries_from;
  }
  for (const IslandParts::Tied& tied : parts.cables) of(*tied.body).cables.push_back(tied.cable);
  return islands;
}

}  // namespace topple::collision
