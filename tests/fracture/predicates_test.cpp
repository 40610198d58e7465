// The orientation's sign against whole-number arithmetic that cannot round.
#include "predicates.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

using namespace topple::fracture;

namespace {

/// Coordinates as whole multiples of 2^-50, so that 128 bits hold the exact determinant.
int exact_sign(const std::array<std::array<long long, 2>, 3>& p) {
  const __int128 left = static_cast<__int128>(p[0][0] - p[2][0]) * (p[1][1] - p[2][1]);
  const __int128 right = static_cast<__int128>(p[0][1] - p[2][1]) * (p[1][0] - p[2][0]);
  return left > right ? 1 : left < right ? -1 : 0;
}

int sign(double value) { return value > 0 ? 1 : value < 0 ? -1 : 0; }

}  // namespace

TEST_CASE("orientation is exact where three points lie almost on a line") {
  std::mt19937_64 random(5);
  int zero = 0;
  for (int k = 0; k < 20000; ++k) {
    // Three points along the line y = x within a few units of the last place.
    std::array<std::array<long long, 2>, 3> whole{};
    std::array<Vec2, 3> point;
    for (std::size_t i = 0; i < 3; ++i) {
      const long long base = static_cast<long long>(random() >> 14);
      for (std::size_t axis = 0; axis < 2; ++axis) {
        whole[i][axis] = base + static_cast<long long>(random() % 3);
        point[i][static_cast<int>(axis)] = std::ldexp(static_cast<double>(whole[i][axis]), -50);
      }
    }
    const int expected = exact_sign(whole);
    zero += expected == 0 ? 1 : 0;
    REQUIRE(sign(orientation(point[0], point[1], point[2])) == expected);
    REQUIRE(sign(orientation(point[1], point[0], point[2])) == -expected);
  }
  CHECK(zero > 500);  // points exactly on a line are among them
}

TEST_CASE("in-circle is certain for clear cases and never for a point on the circle") {
  const Vec2 a(0, 0), b(1, 0), c(1, 1);
  CHECK(certainly_in_circle(a, b, c, Vec2(0.5, 0.9)));
  CHECK_FALSE(certainly_in_circle(a, b, c, Vec2(0, 1)));  // on it
  CHECK_FALSE(certainly_in_circle(a, b, c, Vec2(-0.1, 1.1)));
}

TEST_CASE("a point in a polygon is found exactly, convex or not") {
  const Polygon dented{Vec2(0, 0), Vec2(4, 0), Vec2(4, 3), Vec2(2, 1), Vec2(0, 3)};
  CHECK(encloses(dented, Vec2(1, 1)));
  CHECK_FALSE(encloses(dented, Vec2(2, 1.5)));
  CHECK(encloses(dented, Vec2(2, 1)));  // a corner
  CHECK(encloses(dented, Vec2(3, 2)));  // on an edge
  CHECK(encloses(dented, Vec2(2, 0)));  // on a horizontal edge
  CHECK_FALSE(encloses(dented, Vec2(2, std::nextafter(1.0, 2.0))));
  CHECK_FALSE(encloses(dented, Vec2(5, 0)));
}

TEST_CASE("polygons that cross or touch themselves are not simple") {
  CHECK(is_simple({Vec2(0, 0), Vec2(1, 0), Vec2(1, 1)}));
  CHECK_FALSE(is_simple({Vec2(0, 0), Vec2(1, 1), Vec2(1, 0), Vec2(0, 1)}));              // crosses
  CHECK_FALSE(is_simple({Vec2(0, 0), Vec2(2, 0), Vec2(2, 2), Vec2(1, 0), Vec2(0, 2)}));  // touches an edge
  CHECK_FALSE(is_simple({Vec2(0, 0), Vec2(2, 0), Vec2(1, 0)}));                          // turns back
  CHECK_FALSE(is_simple({Vec2(0, 0), Vec2(0, 0), Vec2(1, 0), Vec2(1, 1)}));              // a corner twice
}
