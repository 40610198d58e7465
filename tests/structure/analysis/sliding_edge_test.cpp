// Shell panels on edges that give in translations, in second order, buckling and modes: rigid bars on springs.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "topple/structure/analysis.h"
#include "topple/structure/formats/files.h"

using namespace topple::structure;

namespace {

constexpr double width = 2, height = 5, thickness = 0.2, weight = 2500 * 9.80665 * thickness * width * height;

/// A wall that stands on its first edge along x and leans in y; joints of all edges have the stiffness given.
Building wall(double E, const std::string& stiffness, const std::string& rest, const std::string& mesh = "[1, 8]") {
  return parse_model(R"({"topple": 1, "materials": {"c": {"youngs_modulus": )" + std::to_string(E) +
                         R"(, "poisson_ratio": 0.0, "density": 2500}}, "joints": {"j": {"stiffness": {)" + stiffness +
                         R"(}}}, "nodes": {"A": [0, 0, 0], "B": [2, 0, 0], "C": [2, 0, 5], "D": [0, 0, 5]},
    "panels": {"S": {"kind": "wall", "nodes": ["A", "B", "C", "D"], "thickness": 0.2, "material": "c", "model": "shell",
                     "mesh": )" +
                         mesh + R"(, "joint": "j"}},)" + rest + "}",
                     "wall.json");
}

}  // namespace

TEST_CASE("a wall on a soft foot leans further under its own weight, and its foot bears the moment of the lean") {
  // Stiff against its foot: it turns by p A h/2 / (k - W h/2), and slides by p A over the other spring.
  constexpr double turn = 2e5, slide = 1e6, push = 100 * width * height;
  const Building b = wall(3e13, R"("ry": 2e5, "z": 1e6)",
                          R"("supports": {"S:1": "fixed"}, "loads": {"case": {"self_weight": 1,
      "panels": {"S": {"pressure": 100}}}})");
  for (const auto mode : {topple::solver::SecondOrder::exact, topple::solver::SecondOrder::cubic}) {
    AnalysisRequest request;
    request.second_order = mode;
    const CombinationResult c = analyse(b, request).combinations[0];
    const double angle = push * height / 2 / (turn - weight * height / 2);
    CHECK(std::abs(c.displacements[2].y()) == Approx(push / slide + height * angle).epsilon(1e-4));
    CHECK(std::abs(c.edge_reactions[0](3)) == Approx(turn * angle).epsilon(1e-4));
    // Stiff against its foot: that costs the reactions nine digits.
    CHECK(std::abs(c.edge_reactions[0].y()) == Approx(push).epsilon(1e-6));
    CHECK(c.edge_reactions[0].z() == Approx(weight).epsilon(1e-6));
    CHECK(c.quality.backward_error <= 1e-14);
  }
  // First order leaves the lean out.
  const CombinationResult first = analyse(b).combinations[0];
  CHECK(std::abs(first.edge_reactions[0](3)) == Approx(push * height / 2).epsilon(1e-5));
}

TEST_CASE("a wall between edges that give sideways buckles as a stiff bar on springs") {
  // Both ends move apart by y against k: the load does 2 P y2/h, the springs take k y2; the bar stays straight.
  constexpr double k = 1e5, load = 1e4;
  AnalysisRequest request;
  request.buckling = 1;
  const AnalysisResult result = analyse(wall(30e9, R"("z": 1e5, "ry": 0)",
                                             R"("supports": {"S:1": "fixed",
      "S:3": {"x": true, "y": true, "rx": true, "ry": true, "rz": true}},
    "loads": {"case": {"nodes": {"C": {"z": -5e3}, "D": {"z": -5e3}}}})"),
                                        request);
  const auto& modes = result.combinations[0].buckling;
  REQUIRE(modes.size() == 1);
  CHECK(modes[0].factor == Approx(k * height / 2 / load).epsilon(1e-6));
  double largest = 0;
  for (const auto& moved : modes[0].shape) largest = std::max(largest, moved.head<3>().norm());
  CHECK(largest == Approx(1).epsilon(1e-12));
}

TEST_CASE("a wall on an elastic bed along its foot bounces as a rod on a spring") {
  // b tan b = k h/(E A), omega = b/h sqrt(E A/m).
  constexpr double E = 30e9, k = 1e8, area = thickness * width;
  AnalysisRequest request;
  request.modes = 8;
  const AnalysisResult result = analyse(wall(E, R"("x": 1e8)", R"("supports": {"S:1": "fixed"})", "[4, 8]"), request);
  double low = 0, high = 1.5;
  for (int i = 0; i < 100; ++i) {
    const double b = (low + high) / 2;
    (b * std::tan(b) < k * height / (E * area) ? low : high) = b;
  }
  const auto bounce = std::max_element(result.modes.begin(), result.modes.end(),
                                       [](const auto& a, const auto& b) { return a.mass_share[2] < b.mass_share[2]; });
  REQUIRE(bounce != result.modes.end());
  CHECK(bounce->angular_frequency == Approx(low / height * std::sqrt(E / 2500)).epsilon(1e-4));  // of the mesh
  CHECK(bounce->mass_share[2] > 0.999);
  CHECK(result.moving_mass.z() == Approx(2500 * area * height).epsilon(1e-9));  // its foot moves too
}
