// The list of moving bodies: what lies side by side is what is there, in order, however bodies come and go.
#include "simulation/debris/bodies.h"

#include <catch2/catch.hpp>
#include <stdexcept>

using namespace topple::structure;

namespace {

Body body(double mass, std::size_t members, std::size_t panels) {
  Body one;
  one.rest.mass = mass;
  for (std::size_t i = 0; i < members; ++i) one.members.emplace_back(i);
  for (std::size_t i = 0; i < panels; ++i) one.panels.emplace_back(i);
  one.bounds.add(Vec3(-3, -1, 0));
  one.bounds.add(Vec3(1, 4, 12));
  return one;
}

std::vector<std::int64_t> ids(const Bodies& bodies) {
  std::vector<std::int64_t> all;
  for (const BodyMotion& one : bodies.motions()) {
    CHECK(one.body == &bodies.at(one.id));
    CHECK(one.mass == bodies.at(one.id).rest.mass);
    all.push_back(one.id);
  }
  return all;
}

std::vector<std::int64_t> list(std::span<const std::int64_t> ids) { return {ids.begin(), ids.end()}; }

}  // namespace

TEST_CASE("motions of bodies are those of the bodies that are there, in order of id") {
  using Ids = std::vector<std::int64_t>;
  Bodies bodies;
  bodies.add(3, body(1, 0, 0));
  bodies.add(5, body(2, 0, 1));
  bodies.add(9, body(3, 2, 0));
  bodies.add(4, body(4, 1, 1));
  bodies.add(11, body(5, 0, 1));
  bodies.add(12, body(6, 1, 0));
  CHECK(ids(bodies) == Ids{3, 4, 5, 9, 11, 12});
  CHECK(list(bodies.single_panels()) == Ids{5, 11});
  CHECK(list(bodies.composed()) == Ids{4, 9});
  CHECK(bodies.motion(3).reach == Approx(13));  // 3, 4, 12
  bodies.motion(9).asleep = true;
  bodies.erase(5);
  bodies.erase(4);
  bodies.erase(7);  // never there
  CHECK(ids(bodies) == Ids{3, 9, 11, 12});
  CHECK(list(bodies.single_panels()) == Ids{11});
  CHECK(list(bodies.composed()) == Ids{9});
  CHECK(bodies.motion(9).asleep);
  CHECK(bodies.size() == 4);
  CHECK_THROWS_AS(bodies.motion(5), std::out_of_range);
  CHECK_THROWS_AS(bodies.add(9, body(1, 0, 0)), std::invalid_argument);
}
