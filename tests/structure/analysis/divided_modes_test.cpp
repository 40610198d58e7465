// Modes with several elements of every member: against closed forms, and against a model whose members are divided by
// nodes of its own. All else stays that of whole members.
#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>

#include "topple/structure/analysis.h"
#include "topple/structure/divide_member.h"
#include "topple/structure/formats/files.h"
#include "topple/structure/member_checks.h"

using namespace topple::structure;
namespace solver = topple::solver;
using Json = nlohmann::json;

namespace {

/// A portal with a load along its beam, which is mass too, a cladding that hands its weight to the beam, and a mass of
/// the beam's own.
Building portal() {
  return parse_model(R"({"topple": 1,
    "materials": {"s": {"youngs_modulus": 2.1e11, "poisson_ratio": 0.3, "density": 7850, "yield_strength": 235e6}},
    "sections": {"col": {"catalogue": "HEB200"}, "beam": {"catalogue": "IPE300"}},
    "nodes": {"A": [0, 0, 0], "B": [0, 0, 4], "C": [8, 0, 4], "D": [8, 0, 0]},
    "members": {"AB": {"kind": "post", "nodes": ["A", "B"], "section": "col", "material": "s"},
                "BC": {"nodes": ["B", "C"], "section": "beam", "material": "s"},
                "DC": {"kind": "post", "nodes": ["D", "C"], "section": "col", "material": "s"}},
    "panels": {"W": {"kind": "wall", "nodes": ["A", "D", "C", "B"], "thickness": 0.02, "material": "s", "model": "cladding"}},
    "supports": {"A": "fixed", "D": "fixed"},
    "masses": {"loads": {"q": 1}, "members": {"BC": 300}},
    "loads": {"q": {"members": {"BC": [{"uniform": {"z": -9000}}]}, "nodes": {"B": {"z": -2e5}}}},
    "combinations": {"u": {"q": 1.35}}})",
                     "portal.json");
}

AnalysisRequest modes_of(int count, int divide, solver::SecondOrder second_order = solver::SecondOrder::none) {
  AnalysisRequest request;
  request.modes = count;
  request.divide = divide;
  request.second_order = second_order;
  return request;
}

}  // namespace

TEST_CASE("divided members have the modes of a model that has nodes there") {
  for (const auto order : {solver::SecondOrder::none, solver::SecondOrder::exact}) {
    const Building whole = portal();
    Building nodes = portal();
    divide_all_members(nodes, 4);
    const AnalysisResult divided = analyse(whole, modes_of(8, 4, order));
    const AnalysisResult given = analyse(nodes, modes_of(8, 1, order));
    REQUIRE(divided.modes.size() == 8);
    for (std::size_t k = 0; k < 8; ++k) {
      CHECK(divided.modes[k].angular_frequency == Approx(given.modes[k].angular_frequency).epsilon(1e-8));
      for (int i = 0; i < 6; ++i)
        CHECK(divided.modes[k].mass_share[static_cast<std::size_t>(i)] ==
              Approx(given.modes[k].mass_share[static_cast<std::size_t>(i)]).margin(1e-6));
    }
    // Both have the inner nodes of AB, BC, DC behind the four of the model, in this order: the shapes are the same.
    const auto &a = divided.modes[0].shape, &b = given.modes[0].shape;
    REQUIRE(a.size() == b.size());
    const double sign = a[1].dot(b[1]) > 0 ? 1 : -1;
    for (std::size_t n = 0; n < a.size(); ++n) CHECK((a[n] - sign * b[n]).norm() < 1e-6);
  }
}

TEST_CASE("dividing members in the modes leaves every other answer as it was") {
  const Building building = portal();
  AnalysisRequest plain = modes_of(3, 1), divided = modes_of(3, 3);
  for (AnalysisRequest* request : {&plain, &divided}) {
    request->stations = design_stations;
    request->critical_sections = true;
    request->buckling = 2;
    request->losses.named = {MemberId(0u)};
  }
  AnalysisResult a = analyse(building, plain), b = analyse(building, divided);
  for (AnalysisResult* result : {&a, &b}) check_design(building, DesignCode::en1993, usual_drift_limit, *result, {});
  CHECK(b.modes[0].angular_frequency != a.modes[0].angular_frequency);
  a.modes = b.modes;
  a.mode_cuts = b.mode_cuts;
  Json one = Json::parse(results_json(building, divided, a, {})),
       other = Json::parse(results_json(building, divided, b, {}));
  CHECK(one == other);
  const Json& combination = other["combinations"]["u"];
  CHECK(combination["members"].size() == 3);
  CHECK(combination["members"]["BC"].contains("utilisation"));
  CHECK(other["losses"].contains("AB"));
  CHECK(other["modes"][0]["shape"].contains("BC/cut-2"));
  CHECK_FALSE(other["buckling"]["u"][0]["shape"].contains("BC/cut-2"));
}

// A pinned IPE 300 of 8 m: pi/2 sqrt(2.1e11 x 604e-8/(7850 x 53.8e-4))/64 = 4.253 Hz about its weak axis; two elements
// are 0.39 % too quick. Its middle moves by 1, a quarter by sin(pi/4): a cubic through the sine's places and slopes
// is 1.5 % below that.
TEST_CASE("a drawing of a mode goes through the inner nodes") {
  const Building beam = parse_model(R"({"topple": 1,
    "materials": {"s": {"youngs_modulus": 2.1e11, "poisson_ratio": 0.3, "density": 7850}},
    "sections": {"b": {"area": 53.8e-4, "Iy": 8356e-8, "Iz": 604e-8, "J": 2e-7}},
    "nodes": {"A": [0, 0, 0], "B": [8, 0, 0]}, "members": {"AB": {"nodes": ["A", "B"], "section": "b", "material": "s"}},
    "supports": {"A": {"x": true, "y": true, "z": true, "rx": true}, "B": {"y": true, "z": true}},
    "loads": {"g": {"self_weight": 1}}})",
                                    "beam.json");
  AnalysisRequest request = modes_of(1, 2);
  request.stations = 8;
  const AnalysisResult result = analyse(beam, request);
  CHECK(result.modes[0].angular_frequency == Approx(1.0039 * 2 * std::numbers::pi * 4.253).epsilon(1e-3));
  REQUIRE(result.mode_cuts.at(0) == std::vector<int>{2});
  CHECK(std::abs(result.modes[0].shape[2].y()) == Approx(1).epsilon(1e-9));
  const std::string drawing = results_vtu(beam, result)[0].second;
  const std::size_t begin = drawing.find('\n', drawing.find("\"mode 1\"")) + 1;
  std::istringstream numbers(drawing.substr(begin));
  std::vector<double> moved(27);
  for (double& number : moved) numbers >> number;
  CHECK(std::abs(moved[3 * 4 + 1]) == Approx(1).epsilon(1e-9));
  CHECK(std::abs(moved[3 * 2 + 1]) == Approx(0.7071).epsilon(0.02));
  CHECK(std::abs(moved[3 * 6 + 1]) == Approx(0.7071).epsilon(0.02));
}

TEST_CASE("a node that has the name of an inner one is told") {
  Building building = portal();
  building.nodes[1].name = "BC/cut-1";
  CHECK_THROWS_WITH(analyse(building, modes_of(1, 2)), Catch::Contains("name of an inner node"));
  CHECK_THROWS(analyse(portal(), modes_of(1, 0)));
}
