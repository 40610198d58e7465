// Walls under their own weight on coarse meshes: what the weight does to the drilling freedoms.
#include <catch2/catch.hpp>
#include <cmath>
#include <sstream>

#include "topple/structure/analysis.h"
#include "topple/structure/formats/files.h"

using namespace topple::structure;

namespace {

constexpr double E = 30e9, density = 2500, gravity = 9.80665, thickness = 0.2;

/// A wall A, B (foot along x), C, D.
CombinationResult wall(double length, double height, double poisson, const std::string& mesh, const std::string& rest) {
  std::ostringstream text;
  text << R"({"topple": 1, "materials": {"c": {"youngs_modulus": 30e9, "poisson_ratio": )" << poisson
       << R"(, "density": 2500}}, "nodes": {"A": [0, 0, 0], "B": [)" << length << R"(, 0, 0], "C": [)" << length
       << ", 0, " << height << R"(], "D": [0, 0, )" << height
       << R"(]}, "panels": {"S": {"kind": "wall", "nodes": ["A", "B", "C", "D"], "thickness": 0.2, "material": "c",
      "model": "shell", "mesh": )"
       << mesh << R"(}}, "loads": {"w": {"self_weight": 1}},)" << rest << "}";
  return analyse(parse_model(text.str(), "wall.json")).combinations.front();
}

}  // namespace

TEST_CASE("a wall shortens under its own weight as a bar does, whatever its mesh") {
  const double height = 5, shortening = density * gravity * height * height / (2 * E);
  for (const char* mesh : {"1", "[1, 8]", "[3, 2]", "[4, 20]"}) {
    const CombinationResult c = wall(2, height, 0, mesh, R"("supports": {"S:1": "fixed"})");
    INFO(mesh);
    for (const std::size_t top : {2, 3}) {
      CHECK(c.displacements[top].z() == Approx(-shortening).epsilon(1e-9));
      CHECK(std::abs(c.displacements[top].x()) < 1e-9 * shortening);
      CHECK(std::abs(c.displacements[top](4)) < 1e-9 * shortening);
    }
    // Nothing turns, so that the foot bears no moment about the wall's normal.
    CHECK(std::abs(c.edge_reactions[0](4)) < 1e-9 * density * gravity * thickness * 2 * height * 2);
  }
}

TEST_CASE("a wall between clamped ends has the end moments of a beam, on one element within 1 %") {
  // From 32 x 16 elements; the limit is a little below W L/12, for the clamped ends are as high as the wall.
  const double length = 6, height = 3, weight = density * gravity * thickness * length * height;
  const auto end_moment = [&](const std::string& mesh) {
    const CombinationResult c = wall(length, height, 0.2, mesh, R"("supports": {"S:2": "fixed", "S:4": "fixed"})");
    return c.edge_reactions[1](4);  // about the middle of the end
  };
  const double fine = end_moment("[32, 16]");
  CHECK(std::abs(fine) == Approx(weight * length / 12).epsilon(0.01));
  CHECK(end_moment("1") == Approx(fine).epsilon(0.01));
  CHECK(end_moment("[4, 2]") == Approx(fine).epsilon(0.01));
}
