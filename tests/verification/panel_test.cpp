// A plate as a panel of a model: mesh, supports of its edges and pressure from the file, results from the analysis.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include "topple/structure/analysis.h"
#include "topple/structure/formats/files.h"
#include "verification/table.h"

using namespace topple::test;
using namespace topple::structure;

namespace {

constexpr double side = 4, thickness = 0.02, pressure = 1000, E = 3e10, nu = 0.3;

CombinationResult plate(const std::string& edge, AnalysisResult& all) {
  const std::string support = "\": " + edge + ", \"";
  const Building building = parse_model(R"({"topple": 1,
    "materials": {"m": {"youngs_modulus": 3e10, "poisson_ratio": 0.3}},
    "nodes": {"A": [0, 0, 0], "B": [4, 0, 0], "C": [4, 4, 0], "D": [0, 4, 0]},
    "panels": {"S": {"nodes": ["A", "B", "C", "D"], "thickness": 0.02, "material": "m", "model": "shell", "mesh": 32}},
    "supports": {"A": {"x": true, "y": true}, "B": {"y": true}, "S:1)" +
                                            support + "S:2" + support + "S:3" + support + "S:4\": " + edge +
                                            R"(}, "loads": {"q": {"panels": {"S": {"pressure": 1000}}}}})",
                                        "plate.json");
  all = analyse(building);
  return all.combinations[0];
}

/// Downward displacement of the mesh node at the middle.
double middle(const AnalysisResult& all) {
  for (std::size_t n = 0; n < all.mesh_nodes.size(); ++n)
    if ((all.mesh_nodes[n] - Vec3(side / 2, side / 2, 0)).norm() < 1e-9)
      return -all.combinations[0].mesh_displacements[n](2);
  FAIL("no mesh node at the middle");
  return 0;
}

}  // namespace

TEST_CASE("a plate drawn as one panel with supported edges bends as series say") {
  const double D = E * thickness * thickness * thickness / (12 * (1 - nu * nu)), load = pressure * side * side;
  AnalysisResult all;
  CombinationResult result = plate(R"({"z": true})", all);
  judge({"panel on simply supported edges, 32 x 32, centre", "Timoshenko", 0.00406235 * load * side * side / D,
         middle(all)},
        0.01);
  judge({"panel on simply supported edges, 32 x 32, moment at the centre", "Timoshenko", 0.0479 * load,
         std::abs(result.panels[0].moments[0])},
        0.01);
  double reaction = 0;
  for (const Vec6& edge : result.edge_reactions) reaction += edge(2);
  judge({"panel on simply supported edges, reactions of the edges", "the load", load, reaction}, 1e-9);
  result = plate(R"("fixed")", all);
  judge({"panel with clamped edges, 32 x 32, centre", "Timoshenko", 0.00126532 * load * side * side / D, middle(all)},
        0.01);
}
