// A strip that is held at its left end, cut through and through.
#include "loose_parts.h"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>

#include "triangulation.h"

using namespace topple::fracture;

namespace {

constexpr int empty = 0, intact = 1, removed = 2;

/// The strip from 0 to 9, 1 wide, its sides tagged 0 to 3 from the lower one on.
class Strip {
 public:
  Strip() : triangles(Vec2(-2, -2), Vec2(11, 3), 1e-6) {
    const std::vector<int> border = label({0, 0, 9, 1}, empty, intact);
    const std::array<Vec2, 4> middle{Vec2(4.5, 0), Vec2(9, 0.5), Vec2(4.5, 1), Vec2(0, 0.5)};
    for (std::size_t i = 0; i < border.size(); ++i) {
      const int from = border[i], to = border[(i + 1) % border.size()];
      const Vec2 at = (triangles.point(from) + triangles.point(to)) / 2;
      const auto side =
          std::find_if(middle.begin(), middle.end(), [&](const Vec2& m) { return (m - at).norm() < 1e-9; });
      REQUIRE(side != middle.end());
      triangles.fix(triangles.find_edge(from, to), static_cast<int>(side - middle.begin()));
    }
  }
  /// Cuts it through between two places; the triangles in between.
  std::vector<int> cut(double from, double to) {
    (void)label({from, -1, to, 2}, intact, removed);
    std::vector<int> gone;
    for (int triangle = 0; triangle < triangles.triangle_slots(); ++triangle)
      if (triangles.alive(triangle) && triangles.label(triangle) == removed) gone.push_back(triangle);
    for (const int triangle : gone) triangles.set_label(triangle, empty);
    return gone;
  }
  [[nodiscard]] double area(const std::vector<int>& part) const {
    double doubled = 0;
    for (const int triangle : part) doubled += triangles.doubled_area(triangle);
    return doubled / 2;
  }

  Triangulation triangles;

 private:
  std::vector<int> label(const std::array<double, 4>& box, int from, int to) {
    std::vector<int> corners, chain, inside, sides;
    for (const Vec2& point : {Vec2(box[0], box[1]), Vec2(box[2], box[1]), Vec2(box[2], box[3]), Vec2(box[0], box[3])})
      corners.push_back(triangles.add_point(point));
    for (std::size_t i = 0; i < 4; ++i) triangles.add_segment(corners[i], corners[(i + 1) % 4], chain);
    REQUIRE(triangles.enclose(chain, inside, sides));
    for (const int triangle : inside)
      if (triangles.label(triangle) == from) triangles.set_label(triangle, to);
    return chain;
  }
};

}  // namespace

TEST_CASE("what a cut leaves of a strip is loose where no end of it is held") {
  Strip strip;
  const std::vector<int> gone = strip.cut(3, 4);
  REQUIRE(strip.area(gone) == Approx(1).epsilon(1e-12));

  const std::vector<bool> left{false, false, false, true}, both{false, true, false, true}, none(4, false);
  const auto one = LooseParts(strip.triangles, left, intact).beside(gone);
  REQUIRE(one.size() == 1);
  CHECK(strip.area(one[0]) == Approx(5).epsilon(1e-12));
  CHECK(LooseParts(strip.triangles, both, intact).beside(gone).empty());
  const auto two = LooseParts(strip.triangles, none, intact).beside(gone);
  REQUIRE(two.size() == 2);
  CHECK(strip.area(two[0]) + strip.area(two[1]) == Approx(8).epsilon(1e-12));
}

TEST_CASE("a part between two cuts is loose, and found from any of its triangles") {
  Strip strip;
  (void)strip.cut(2, 3);
  (void)strip.cut(6, 7);
  const std::vector<bool> both{false, true, false, true};
  std::vector<int> all;
  for (int triangle = 0; triangle < strip.triangles.triangle_slots(); ++triangle)
    if (strip.triangles.alive(triangle) && strip.triangles.label(triangle) == intact) all.push_back(triangle);
  const auto loose = LooseParts(strip.triangles, both, intact).around(all);
  REQUIRE(loose.size() == 1);
  CHECK(strip.area(loose[0]) == Approx(3).epsilon(1e-12));
  for (const int triangle : loose[0]) CHECK(LooseParts(strip.triangles, both, intact).around({triangle}).size() == 1);
}
