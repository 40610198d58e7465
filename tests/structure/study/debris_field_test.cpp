// Where debris lies, as numbers of a sample.
#include <catch2/catch.hpp>

#include "study/debris_field.h"

using namespace topple::structure;
using namespace topple::structure::study;

namespace {

/// A square of 1 m.
FallenBody square(double x, double y, double mass, double reach) {
  return {reach, mass, {{x, y}, {x + 1, y}, {x + 1, y + 1}, {x, y + 1}}};
}

}  // namespace

TEST_CASE(
    "The footprint of most of the debris leaves out whole bodies, the farthest first, as long as their mass allows") {
  const std::vector<FallenBody> bodies{square(0, 0, 50, 0), square(9, 0, 1, 3), square(4, 3, 46, 1),
                                       square(0, 99, 3, 90)};
  CHECK(footprint_without_farthest(bodies, 0) == Approx(554.5));  // corners (0,0) (10,0) (10,1) (1,100) (0,100)
  CHECK(footprint_without_farthest(bodies, 2.9) == footprint_without_farthest(bodies, 0));
  CHECK(footprint_without_farthest(bodies, 3) == Approx(26.5));
  CHECK(footprint_without_farthest(bodies, 4) == Approx(8));
  CHECK(footprint_without_farthest(bodies, 49) == Approx(8));
  CHECK(footprint_without_farthest(bodies, 50) == Approx(1));
  CHECK(footprint_without_farthest(bodies, 100) == 0);
}

TEST_CASE("A hull has the corners alone, counter-clockwise, and points are as far from it as from its nearest edge") {
  const std::vector<Vec2> hull = convex_hull({{0, 0}, {2, 0}, {1, 0}, {2, 2}, {1, 1}, {0, 2}, {0, 0}});
  REQUIRE(hull.size() == 4);
  CHECK(area_of(hull) == 4);
  CHECK(distance_outside(hull, {1, 1}) == 0);
  CHECK(distance_outside(hull, {5, 6}) == 5);
  CHECK(distance_outside(hull, {1, -3}) == 3);
}
