// Contacts of one pair, step by step.
#include "contacts/pair_contacts.h"

#include <catch2/catch.hpp>

#include "shapes/polyhedron_store.h"
#include "shapes/touching_solid.h"

using namespace topple::collision;

TEST_CASE("two that pass each other's edges at speed are looked at again before they can touch") {
  constexpr double kept = 0.005, matched = 0.1, half = 0.5;
  PolyhedronStore polyhedra;
  ConvexPart part;
  part.kind = ConvexPart::Kind::box;
  part.half_extents = Vec3::Constant(half);
  TouchingSolid one;
  make_parts({part}, "box", polyhedra, one);
  make_shapes(one);
  Placement first, second;
  first.turn = second.turn = Mat3::Identity();
  first.position = Vec3::Zero();
  PairMotion motion{&one.shapes[0], &one.shapes[0], &first, &second, 0, 0};
  NearPair pair;
  // Edge to edge, 0.085 m apart and 0.06 m along each face's normal. They could come together by 0.4 m in this step, so
  // that no face is farther than that; of none does a point lie over the other.
  second.position = Vec3(2 * half + 0.06, 2 * half + 0.06, 0);
  motion.margin = 0.4;
  const double free = update_contacts(pair, motion, kept, matched);
  CHECK(pair.manifold.count == 0);
  CHECK(free <= 0.085);
  CHECK(free > 0.05);
  // They came together by less than 0.4 m, and go on slowly.
  second.position = Vec3(2 * half - 0.1, 2 * half - 0.14, 0);
  motion.margin = 0.02;
  CHECK(update_contacts(pair, motion, kept, matched) == 0);
  REQUIRE(pair.manifold.count > 0);
  double deepest = 1;
  for (int i = 0; i < pair.manifold.count; ++i)
    deepest = std::min(deepest, pair.manifold.points[static_cast<std::size_t>(i)].separation);
  CHECK(deepest == Approx(-0.1).margin(1e-9));
}
