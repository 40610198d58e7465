// Pairs of bounds that meet, alone: by chance what comes, moves and goes, against a look at all of them.
#include <algorithm>
#include <catch2/catch.hpp>
#include <list>
#include <random>
#include <set>

#include "contacts/near_pairs.h"

using namespace topple::collision;

namespace {

/// Boxes of solids with two parts each, which are no pair; every third stands. Each is known by its order.
struct Crowd {
  struct One {
    Solid* solid = nullptr;
    std::uint32_t collider = 0;
    std::uint64_t order = 0;
  };
  NearPairs pairs;
  std::list<Solid> solids;  // whose addresses stay
  Solid ground;
  std::vector<One> all;
  std::uint64_t added = 0;
  std::mt19937 random;

  explicit Crowd(unsigned seed) : random(seed) { pairs.set_ground(&ground, 0.5); }

  int below(int count) { return static_cast<int>(random() % static_cast<unsigned>(count)); }
  Box3 box() {
    const Vec3 low(below(12), below(4), below(4));
    return {low, low + Vec3(1 + below(3), 1, 1)};
  }
  void add() {
    Solid& solid = solids.emplace_back();
    solid.kind = solids.size() % 3 == 0 ? Touched::Kind::obstacle : Touched::Kind::body;
    for (int part = 0; part < 2; ++part) {
      all.push_back({&solid, pairs.add(&solid, part, added, box()), added});
      ++added;
    }
  }
  void move() { pairs.move(all[static_cast<std::size_t>(below(std::ssize(all)))].collider, box(), 0.25); }
  void remove() {
    const auto gone = all.begin() + below(std::ssize(all));
    pairs.remove(gone->collider);
    all.erase(gone);
  }
  int below(std::ptrdiff_t count) { return below(static_cast<int>(count)); }

  using Orders = std::vector<std::pair<std::uint64_t, std::uint64_t>>;
  [[nodiscard]] Orders told() const {
    Orders orders;
    for (const std::uint32_t index : pairs.order())
      orders.emplace_back(pairs.ends(index).first_order, pairs.ends(index).second_order);
    return orders;
  }
  [[nodiscard]] Orders looked_at_one_by_one() const {
    std::set<std::pair<std::uint64_t, std::uint64_t>> found;
    const std::uint64_t of_ground = pairs.collider(NearPairs::ground).order;
    for (const One& a : all) {
      const Collider& one = pairs.collider(a.collider);
      if (!one.stands && one.fat.low.z() <= 0.5) found.emplace(a.order, of_ground);
      for (const One& b : all) {
        const Collider& other = pairs.collider(b.collider);
        if (a.order < b.order && a.solid != b.solid && !(one.stands && other.stands) && one.fat.meets(other.fat))
          found.emplace(a.order, b.order);
      }
    }
    return {found.begin(), found.end()};
  }
};

}  // namespace

TEST_CASE("near pairs: those whose bounds meet, once each and in order, whatever came, moved and went") {
  for (unsigned seed = 0; seed < 20; ++seed) {
    Crowd crowd(seed);
    for (int turn = 0; turn < 40; ++turn) {
      for (int change = crowd.below(8); change >= 0; --change) {
        const int kind = crowd.all.empty() ? 0 : crowd.below(8);
        kind == 0 ? crowd.add() : kind == 1 ? crowd.remove() : crowd.move();
      }
      crowd.pairs.find();
      REQUIRE(crowd.told() == crowd.looked_at_one_by_one());
    }
  }
}

TEST_CASE("near pairs: what moved may be sought for in any order") {
  Crowd one(7), other(7);
  for (int turn = 0; turn < 60; ++turn) {
    for (Crowd* crowd : {&one, &other}) {
      if (turn < 12) crowd->add();
      for (int i = 0; i < 5; ++i) crowd->move();
    }
    one.pairs.find();
    std::vector<std::uint32_t> far;
    for (const std::uint32_t index : other.pairs.order())
      if (other.pairs.is_far(other.pairs.ends(index))) far.push_back(index);
    other.pairs.drop(far);
    for (std::size_t i = other.pairs.moved_count(); i-- > 0;) other.pairs.seek(i);
    other.pairs.take_found();
    REQUIRE(one.told() == other.told());
  }
}
