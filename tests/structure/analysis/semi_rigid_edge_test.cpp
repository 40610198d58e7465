// Edges of shell panels whose joint gives: hinges and springs along an edge against supports that say the same, and
// against beams.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <sstream>

#include "topple/structure/analysis.h"
#include "topple/structure/error.h"
#include "topple/structure/formats/files.h"

using namespace topple;
using namespace topple::structure;

namespace {

Building model(const std::string& rest) {
  return parse_model(R"({"topple": 1, "materials": {"c": {"youngs_modulus": 30e9, "poisson_ratio": 0.0, "density": 2500,
    "thermal_expansion": 1e-5}}, "sections": {"s": {"area": 0.06, "Iy": 4e-4, "Iz": 2e-4, "J": 3e-4}},)" +
                         rest + "}",
                     "model.json");
}

constexpr double E = 30e9, width = 2, length = 5, thickness = 0.2;
constexpr double bending = E * width * thickness * thickness * thickness / 12, axial = E * width * thickness;

/// Place and direction of a strip whose length, width and normal are no axis of anything.
const Mat3 turned = (Eigen::AngleAxisd(0.7, Vec3(1, 2, -0.5).normalized())).toRotationMatrix();
std::string node(double along, double across) {
  const Vec3 p = turned * Vec3(along, across, 0) + Vec3(3, -2, 7);
  std::ostringstream text;
  text.precision(17);
  text << '[' << p.x() << ',' << p.y() << ',' << p.z() << ']';
  return text.str();
}
/// A strip from A, D to B, C, held at its edge 4 (D to A), under its weight times the components given in its axes.
AnalysisResult strip(const std::string& joint, const Vec3& weight, const std::string& more_loads = "",
                     const std::string& supports = R"("S:4": "fixed")") {
  const Vec3 global = turned * weight;
  std::ostringstream vector;
  vector.precision(17);
  vector << '[' << global.x() << ',' << global.y() << ',' << global.z() << ']';
  return analyse(model(R"("nodes": {"A": )" + node(0, 0) + R"(, "B": )" + node(length, 0) + R"(, "C": )" +
                       node(length, width) + R"(, "D": )" + node(0, width) + R"(}, "joints": {"j": {)" + joint +
                       R"(}}, "panels": {"S": {"nodes": ["A", "B", "C", "D"], "thickness": 0.2, "material": "c",
      "model": "shell", "mesh": [4, 1], "joint": "j"}}, "supports": {)" +
                       supports + R"(}, "loads": {"case": {"self_weight": )" + vector.str() + more_loads + "}}"));
}
Vec3 end_of(const AnalysisResult& result) {
  const auto& u = result.combinations[0].displacements;
  return turned.transpose() * (u[1] + u[2]).head<3>() / 2;
}

}  // namespace

TEST_CASE("a hinge along an edge is the support that does not hold that turn") {
  const auto plate = [](const std::string& joint, const std::string& supports) {
    return analyse(model(R"("nodes": {"A": [0, 0, 0], "B": [4, 0, 0], "C": [4, 3, 0], "D": [0, 3, 0]},
      "joints": {"j": {"stiffness": {)" +
                         joint + R"(}}}, "panels": {"S": {"nodes": ["A", "B", "C", "D"], "thickness": 0.1,
        "material": "c", "model": "shell", "mesh": 6, "joint": "j",
        "openings": [[[1, 1], [2, 1], [2, 1.7], [1, 1.7]]]}}, "supports": {)" +
                         supports + R"(},
      "loads": {"case": {"self_weight": 1, "panels": {"S": {"pressure": 5e3, "temperature": 11}}}})"));
  };
  const AnalysisResult hinged =
      plate(R"("ry": 0)", R"("S:1": "fixed", "S:2": "fixed", "S:3": "fixed", "S:4": "fixed")");
  // Edges 1 and 3 lie along x, 2 and 4 along y. At corners either edge holds what the other lets go of.
  const std::string x = R"({"x": true, "y": true, "z": true, "ry": true, "rz": true})",
                    y = R"({"x": true, "y": true, "z": true, "rx": true, "rz": true})";
  const AnalysisResult held =
      plate("", R"("S:1": )" + x + R"(, "S:2": )" + y + R"(, "S:3": )" + x + R"(, "S:4": )" + y);
  const CombinationResult &a = hinged.combinations[0], &b = held.combinations[0];
  double largest = 0;
  for (const Vec6& u : b.mesh_displacements) largest = std::max(largest, u.norm());
  for (std::size_t n = 0; n < b.mesh_displacements.size(); ++n) {
    // Nodes of the mesh come first in both; those on the edges do not move in the hinged one, its own side does.
    const Vec6 difference = a.mesh_displacements[n] - b.mesh_displacements[n];
    if (difference.head<3>().norm() > 1e-11 * largest) FAIL("mesh node " << n << " moves differently");
  }
  REQUIRE(a.panels[0].elements.size() == b.panels[0].elements.size());
  for (std::size_t k = 0; k < b.panels[0].elements.size(); ++k)
    for (std::size_t i = 0; i < 3; ++i) {
      CHECK(std::abs(a.panels[0].elements[k].moments[i] - b.panels[0].elements[k].moments[i]) < 1e-8 * 5e3);
      CHECK(std::abs(a.panels[0].elements[k].membrane[i] - b.panels[0].elements[k].membrane[i]) < 1e-8 * 1e6);
    }
  for (std::size_t i = 0; i < b.edge_reactions.size(); ++i) CHECK(b.edge_reactions.size() == a.edge_reactions.size());
  Vec6 sum_a = Vec6::Zero(), sum_b = Vec6::Zero();
  for (std::size_t i = 0; i < 4; ++i) sum_a += a.edge_reactions[i], sum_b += b.edge_reactions[i];
  CHECK((sum_a - sum_b).head<3>().norm() < 1e-10 * sum_b.head<3>().norm());
  CHECK(a.equilibrium_error < 1e-11);
  CHECK(a.quality.backward_error <= 1e-14);
}

TEST_CASE("springs along an edge add their own motion to that of a strip, whatever its direction") {
  // Statically determinate and without Poisson's ratio: what the spring gives is added to rounding. The free edges'
  // joints carry nothing.
  const Vec3 weight(3, 0, -0.1);
  const Vec3 force = 2500 * 9.80665 * thickness * width * length * weight;
  const Vec3 rigid = end_of(strip("", weight));
  CHECK(rigid.z() == Approx(force.z() * std::pow(length, 3) / (8 * bending)).epsilon(0.03));  // 4 elements
  const auto more = [&](const std::string& stiffness) {
    return Vec3(end_of(strip(R"("stiffness": {)" + stiffness + "}", weight)) - rigid);
  };
  constexpr double k = 4e6;
  // Edge 4 runs from D to A: x out of the strip, y along the edge, z the normal.
  const Vec3 x(force.x() / k, 0, 0), z(0, 0, force.z() / k), ry(0, 0, force.z() * length / 2 / k * length);
  const double rounding = 1e-9 * (x.norm() + ry.norm());
  CHECK((more(R"("x": 4e6)") - x).norm() < rounding);
  CHECK((more(R"("z": 4e6)") - z).norm() < rounding);
  CHECK((more(R"("ry": 4e6)") - ry).norm() < rounding);
  CHECK((more(R"("x": 4e6, "ry": 4e6, "z": 4e6)") - x - z - ry).norm() < rounding);
  CHECK_THROWS_AS(more(R"("ry": 0)"), UnstableModel);
}

TEST_CASE("a heated strip between springs pushes against them") {
  constexpr double k = 3e8, heat = 40, strain = 1e-5 * heat;
  const AnalysisResult result =
      strip(R"("stiffness": {"x": 3e8})", Vec3::Zero(), R"(, "panels": {"S": {"temperature": 40}})",
            R"("S:4": "fixed", "S:2": {"x": true, "y": true, "z": true, "rx": true, "ry": true, "rz": true})");
  const double push = strain * length / (length / axial + 2 / k);  // at nu = 0 the width swells freely, but at the ends
  const CombinationResult& c = result.combinations[0];
  // Held at its ends the strip cannot swell sideways there; at nu = 0 that changes no force along it on the whole.
  double mean = 0;
  for (const PanelElement& element : c.panels[0].elements) mean += element.membrane[0] / 4;
  CHECK(mean == Approx(-push / width).epsilon(1e-9));
  const Vec3 reaction = turned.transpose() * Vec3(c.edge_reactions[0].head<3>());
  CHECK(reaction.x() == Approx(push).epsilon(1e-9));
  CHECK(c.equilibrium_error < 1e-10);
}

TEST_CASE("two panels hinged to each other share a line that turns freely and is no mechanism") {
  // Clamped, hinge, clamped: under a load on the hinge each half is a cantilever with half of it.
  const AnalysisResult result =
      analyse(model(R"("nodes": {"A": [0, 0, 0], "B": [5, 0, 0], "C": [5, 2, 0], "D": [0, 2, 0],
      "E": [10, 0, 0], "F": [10, 2, 0]}, "joints": {"hinge": {"stiffness": {"ry": 0}}},
    "panels": {"left": {"nodes": ["A", "B", "C", "D"], "thickness": 0.2, "material": "c", "model": "shell", "mesh": [8, 1]},
               "right": {"nodes": ["B", "E", "F", "C"], "thickness": 0.2, "material": "c", "model": "shell", "mesh": [8, 1], "joint": "hinge"}},
    "supports": {"A": "fixed", "D": "fixed", "E": "fixed", "F": "fixed", "left:4": "fixed"},
    "loads": {"case": {"nodes": {"B": {"z": -1e4}, "C": {"z": -1e4}}}})"));
  const double shear = 5.0 / 6 * E / 2 * width * thickness;
  // The right end stands on nodes: at its corners the joints of both edges hold it, so that it is clamped there as
  // well.
  const double expected = -1e4 * (std::pow(length, 3) / (3 * bending) + length / shear);
  CHECK(result.combinations[0].displacements[1].z() == Approx(expected).epsilon(0.01));
  const AnalysisResult both = analyse(model(R"("nodes": {"A": [0, 0, 0], "B": [5, 0, 0], "C": [5, 2, 0], "D": [0, 2, 0],
      "E": [10, 0, 0], "F": [10, 2, 0]}, "joints": {"hinge": {"stiffness": {"ry": 0}}},
    "panels": {"left": {"nodes": ["B", "C", "D", "A"], "thickness": 0.2, "material": "c", "model": "shell", "mesh": [1, 8], "joint": "hinge"},
               "right": {"nodes": ["B", "E", "F", "C"], "thickness": 0.2, "material": "c", "model": "shell", "mesh": [8, 1], "joint": "hinge"}},
    "supports": {"A": "fixed", "D": "fixed", "E": "fixed", "F": "fixed"},
    "loads": {"case": {"nodes": {"B": {"z": -1e4, "x": 1e3}, "C": {"z": -1e4}}}})"));
  CHECK(both.combinations[0].displacements[1].z() == Approx(expected).epsilon(0.01));
  CHECK(both.combinations[0].quality.backward_error <= 1e-14);
  const CombinationResult& c = both.combinations[0];
  CHECK((c.total_load + c.total_reaction).norm() < 1e-9 * c.total_load.norm());
}

TEST_CASE("a strip on hinged edges buckles as Euler's column, one on rigid edges as a clamped one") {
  const auto factor = [](const std::string& joint) {
    AnalysisRequest request;
    request.buckling = 1;
    const Building b = model(R"("nodes": {"A": [0, 0, 0], "B": [2, 0, 0], "C": [2, 0, 5], "D": [0, 0, 5]},
      "joints": {"j": {)" + joint +
                             R"(}}, "panels": {"S": {"kind": "wall", "nodes": ["A", "B", "C", "D"], "thickness": 0.05,
        "material": "c", "model": "shell", "mesh": [1, 16], "joint": "j"}},
      "supports": {"S:1": "fixed", "S:3": {"x": true, "y": true, "rx": true, "ry": true, "rz": true}},
      "loads": {"case": {"nodes": {"C": {"z": -1e3}, "D": {"z": -1e3}}}})");
    return analyse(b, request).combinations[0].buckling[0].factor;
  };
  const double euler = std::pow(std::numbers::pi / 5, 2) * E * 2 * std::pow(0.05, 3) / 12 / 2e3;
  CHECK(factor(R"("stiffness": {"ry": 0})") == Approx(euler).epsilon(0.01));
  CHECK(factor("") == Approx(4 * euler).epsilon(0.03));
}

TEST_CASE("a demolition refuses edges that give") {
  CHECK_THROWS_WITH(
      parse_model(R"({"topple": 1, "materials": {"c": {"youngs_modulus": 30e9, "poisson_ratio": 0.2, "density": 2500}},
      "nodes": {"A": [0, 0, 0], "B": [4, 0, 0], "C": [4, 4, 0], "D": [0, 4, 0]},
      "joints": {"hinge": {"stiffness": {"ry": 0}}}, "supports": {"S:1": "fixed"},
      "panels": {"S": {"nodes": ["A", "B", "C", "D"], "thickness": 0.2, "material": "c", "model": "shell", "mesh": 1, "joint": "hinge"}}})",
                  "model.json", Purpose::demolish),
      Catch::Contains("joint S:1: `stiffness` of a shell's edge"));
}
