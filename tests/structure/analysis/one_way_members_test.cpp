// Tension-only and compression-only members: the state found is the right one, verified against statics by hand.
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "topple/structure/analysis.h"
#include "topple/structure/error.h"
#include "topple/structure/formats/files.h"

using namespace topple::structure;

namespace {

/// A pinned bay of 4 m by 3 m with two crossing ties, pushed sideways at its top by `push`; posts and beam are hinged.
Building braced_bay(double push, const std::string& axial, const std::string& more = "") {
  const std::string both_hinged = R"("joints": ["hinge", "hinge"])";
  return parse_model(R"({"topple": 1,
    "materials": {"steel": {"youngs_modulus": 2e11, "shear_modulus": 8e10}},
    "sections": {"post": {"area": 0.01, "Iy": 1e-4, "Iz": 1e-4, "J": 1e-4}, "tie": {"area": 0.001, "Iy": 1e-8, "Iz": 1e-8, "J": 1e-8}},
    "joints": {"hinge": {"stiffness": {"ry": 0, "rz": 0}}},
    "nodes": {"A0": [0, 0, 0], "A1": [0, 0, 3], "B0": [4, 0, 0], "B1": [4, 0, 3]},
    "members": {
      "PA": {"kind": "post", "nodes": ["A0", "A1"], "section": "post", "material": "steel", )" +
                         both_hinged + R"(},
      "PB": {"kind": "post", "nodes": ["B0", "B1"], "section": "post", "material": "steel", )" +
                         both_hinged + R"(},
      "AB": {"nodes": ["A1", "B1"], "section": "post", "material": "steel", )" +
                         both_hinged + R"(},
      "X1": {"kind": "brace", "nodes": ["A0", "B1"], "section": "tie", "material": "steel", "axial": ")" +
                         axial + R"(", )" + both_hinged + R"(},
      "X2": {"kind": "brace", "nodes": ["B0", "A1"], "section": "tie", "material": "steel", "axial": ")" +
                         axial + R"(", )" + both_hinged + R"(}},
    "supports": {"A0": {"x": true, "y": true, "z": true, "rx": true, "rz": true}, "B0": {"x": true, "y": true, "z": true, "rx": true, "rz": true},
                 "A1": {"y": true, "rx": true, "rz": true}, "B1": {"y": true, "rx": true, "rz": true}},
    "loads": {"push": {"nodes": {"A1": {"x": )" +
                         std::to_string(push) + R"(}}}})" + more + "}",
                     "bay.json");
}

const MemberResult& member(const Building& building, const CombinationResult& result, const std::string& name) {
  return result.members[static_cast<std::size_t>(NameIndex(building).member(name)->index)];
}

double axial_force(const MemberResult& member) { return member.end_forces(6); }

}  // namespace

TEST_CASE("of two crossing ties the stretched one carries the storey's shear alone and the other is slack") {
  for (const double push : {1e4, -1e4}) {
    const Building building = braced_bay(push, "tension");
    const CombinationResult result = analyse(building).combinations.front();
    const std::string taut = push > 0 ? "X1" : "X2", slack = push > 0 ? "X2" : "X1";
    CHECK(member(building, result, taut).active);
    CHECK_FALSE(member(building, result, slack).active);
    // 4 m in 5 m of its length act along the push.
    CHECK(axial_force(member(building, result, taut)) == Approx(1e4 * 5 / 4).epsilon(1e-12));
    CHECK(axial_force(member(building, result, slack)) == 0);
    CHECK(result.equilibrium_error < 1e-12);
  }
}

TEST_CASE("struts that carry compression only are the mirror image of ties") {
  const Building building = braced_bay(1e4, "compression");
  const CombinationResult result = analyse(building).combinations.front();
  CHECK_FALSE(member(building, result, "X1").active);
  CHECK(axial_force(member(building, result, "X2")) == Approx(-1e4 * 5 / 4).epsilon(1e-12));
}

TEST_CASE("members without a sign share the shear by their stiffness, so the state of ties is a different one") {
  const Building building = braced_bay(1e4, "both");
  const CombinationResult result = analyse(building).combinations.front();
  const double first = axial_force(member(building, result, "X1")),
               second = axial_force(member(building, result, "X2"));
  CHECK(first > 0);
  CHECK(second < 0);
  CHECK((first - second) * 4 / 5 == Approx(1e4).epsilon(1e-12));
}

TEST_CASE("a bay whose ties all go slack is unstable, and the message says in which combination") {
  // The posts shorten under the load; both ties would be compressed, and nothing else holds the bay.
  Building building = braced_bay(0, "tension");
  building.cases.front().nodes.clear();
  for (const char* top : {"A1", "B1"}) {
    Vec6 down = Vec6::Zero();
    down(2) = -1e6;
    building.cases.front().nodes.push_back({*NameIndex(building).node(top), down});
  }
  CHECK_THROWS_AS(analyse(building), UnstableModel);
  CHECK_THROWS_WITH(analyse(building),
                    Catch::Contains("combination push, with members slack") && Catch::Contains("along x"));
}

TEST_CASE("ties that the posts' shortening compresses both carry a push all the same, whatever its size") {
  // With both taut both would be pressed, with both slack the bay falls over: one holds it.
  for (const double push : {2e5, 1e4, 1.0, -1.0, -3e4}) {
    Building building = braced_bay(push, "tension");
    for (const char* top : {"A1", "B1"}) {
      Vec6 down = Vec6::Zero();
      down(2) = -1e6;
      building.cases.front().nodes.push_back({*NameIndex(building).node(top), down});
    }
    const CombinationResult result = analyse(building).combinations.front();
    const std::string taut = push > 0 ? "X1" : "X2", slack = push > 0 ? "X2" : "X1";
    INFO("push " << push);
    CHECK(member(building, result, taut).active);
    CHECK_FALSE(member(building, result, slack).active);
    CHECK(axial_force(member(building, result, taut)) == Approx(std::abs(push) * 5 / 4).epsilon(1e-9));
    CHECK(axial_force(member(building, result, slack)) == 0);
    CHECK(result.quality.backward_error <= 1e-14);
  }
}

TEST_CASE("a braced tower of pinned storeys finds its ties under any weight and wind") {
  // Six storeys, ties both ways in each, all pressed by the posts' shortening: by statics the one that leans with the
  // storey's shear bears it alone, 4 m in 5 m of its length, and the other is slack.
  const int storeys = 6;
  std::string nodes = R"("L0": [0, 0, 0], "R0": [4, 0, 0])", members, supports, comma;
  for (int k = 1; k <= storeys; ++k) {
    const std::string now = std::to_string(k), below = std::to_string(k - 1), z = std::to_string(3 * k);
    nodes += ", \"L" + now + "\": [0, 0, " + z + "], \"R" + now + "\": [4, 0, " + z + "]";
    const auto add = [&](const std::string& name, const std::string& from, const std::string& to, bool tie) {
      members += comma + "\"" + name + now + R"(": {"kind": ")" + (tie ? "brace" : "post") + R"(", "nodes": [")" +
                 from + "\", \"" + to + R"("], "section": ")" + (tie ? "tie" : "post") + R"(", "material": "steel", )" +
                 (tie ? R"("axial": "tension", )" : "") + R"("joints": ["hinge", "hinge"]})";
      comma = ", ";
    };
    add("PL", "L" + below, "L" + now, false);
    add("PR", "R" + below, "R" + now, false);
    add("B", "L" + now, "R" + now, false);
    add("U", "L" + below, "R" + now, true);
    add("D", "R" + below, "L" + now, true);
    for (const char* side : {"L", "R"}) supports += ", \"" + (side + now) + R"(": {"y": true, "rx": true, "rz": true})";
  }
  const std::string foot = R"({"x": true, "y": true, "z": true, "rx": true, "rz": true})";
  Building building = parse_model(
      R"({"topple": 1, "materials": {"steel": {"youngs_modulus": 2e11, "shear_modulus": 8e10}},
      "sections": {"post": {"area": 0.01, "Iy": 1e-5, "Iz": 1e-5, "J": 1e-5}, "tie": {"area": 0.001, "Iy": 1e-8, "Iz": 1e-8, "J": 1e-8}},
      "joints": {"hinge": {"stiffness": {"ry": 0, "rz": 0}}}, "nodes": {)" +
          nodes + "}, \"members\": {" + members + R"(}, "supports": {"L0": )" + foot + R"(, "R0": )" + foot + supports +
          R"(}, "loads": {"all": {}}})",
      "tower.json");
  const NameIndex names(building);
  std::mt19937 random(7);
  const auto between = [&](double low, double high) {
    return low + (high - low) * (static_cast<double>(random()) / 4294967296.0);
  };
  for (int round = 0; round < 60; ++round) {
    std::vector<double> push;
    building.cases.front().nodes.clear();
    for (int k = 1; k <= storeys; ++k) {
      push.push_back(between(-1, 1) * std::pow(10, between(1, 4)));
      for (const char* side : {"L", "R"}) {
        Vec6 load = Vec6::Zero();
        load(0) = *side == 'L' ? push.back() : 0;
        load(2) = -between(3e5, 6e5);
        building.cases.front().nodes.push_back({*names.node(side + std::to_string(k)), load});
      }
    }
    const CombinationResult result = analyse(building).combinations.front();
    double shear = 0;
    for (int k = storeys; k >= 1; --k) {
      shear += push[static_cast<std::size_t>(k - 1)];
      const std::string taut = (shear > 0 ? "U" : "D") + std::to_string(k),
                        slack = (shear > 0 ? "D" : "U") + std::to_string(k);
      INFO("round " << round << ", " << taut << ", shear " << shear);
      CHECK(axial_force(member(building, result, taut)) == Approx(std::abs(shear) * 5 / 4).epsilon(1e-8));
      CHECK(axial_force(member(building, result, slack)) == 0);
    }
  }
}

TEST_CASE("every state that is found holds: ties pull, slack ties would be compressed") {
  // Ten bays in a row, ties both ways in each, moments in the beam's line: many ties, pushed from either side.
  std::string nodes, members, comma;
  const int bays = 10;
  for (int i = 0; i <= bays; ++i) {
    const std::string k = std::to_string(i), x = std::to_string(4 * i);
    nodes += comma + "\"L" + k + "\": [" + x + ", 0, 0], \"H" + k + "\": [" + x + ", 0, 3]";
    members += comma + "\"P" + k + R"(": {"kind": "post", "nodes": ["L)" + k + "\", \"H" + k +
               R"("], "section": "post", "material": "steel"})";
    if (i > 0) {
      const std::string b = std::to_string(i - 1);
      members +=
          ", \"B" + k + R"(": {"nodes": ["H)" + b + "\", \"H" + k + R"("], "section": "post", "material": "steel"})";
      members += ", \"U" + k + R"(": {"kind": "brace", "nodes": ["L)" + b + "\", \"H" + k +
                 R"("], "section": "tie", "material": "steel", "axial": "tension", "joints": ["hinge", "hinge"]})";
      members += ", \"D" + k + R"(": {"kind": "brace", "nodes": ["H)" + b + "\", \"L" + k +
                 R"("], "section": "tie", "material": "steel", "axial": "tension", "joints": ["hinge", "hinge"]})";
    }
    comma = ", ";
  }
  std::string supports, down, sep;
  for (int i = 0; i <= bays; ++i) {
    supports += sep + "\"L" + std::to_string(i) + "\": \"fixed\"";
    down += sep + "\"H" + std::to_string(i) + R"(": {"z": -)" + std::to_string(20000 * (i % 3 + 1)) + R"(, "x": )" +
            std::to_string(i % 2 ? 9000 : -7000) + "}";
    sep = ", ";
  }
  const Building building = parse_model(
      R"({"topple": 1, "materials": {"steel": {"youngs_modulus": 2e11, "shear_modulus": 8e10, "density": 7850}},
      "sections": {"post": {"area": 0.01, "Iy": 1e-5, "Iz": 1e-5, "J": 1e-5}, "tie": {"area": 0.001, "Iy": 1e-8, "Iz": 1e-8, "J": 1e-8}},
      "joints": {"hinge": {"stiffness": {"ry": 0, "rz": 0}}},
      "nodes": {)" +
          nodes + "}, \"members\": {" + members + "}, \"supports\": {" + supports +
          "}, \"loads\": {\"all\": {\"self_weight\": 1, \"nodes\": {" + down + "}}}}",
      "row.json");
  const CombinationResult result = analyse(building).combinations.front();
  int taut = 0, slack = 0;
  for (std::size_t m = 0; m < building.members.size(); ++m) {
    const Member& own = building.members[m];
    if (own.axial == AxialAction::both) continue;
    const MemberResult& found = result.members[m];
    const std::size_t low = own.axes(0, 2) > 0 ? 0 : 1;
    const double at_low_end = low == 0 ? -found.end_forces(0) : found.end_forces(6);
    if (found.active) {
      ++taut;
      CHECK(at_low_end > -1e-9);
    } else {
      ++slack;
      CHECK(std::abs(at_low_end) < 1e-9);
      // The distance between its nodes shrank by more than its own weight stretches it.
      const Vec3 axis = own.axes.row(0);
      const double stretch = axis.dot((result.displacements[static_cast<std::size_t>(own.nodes[1].index)] -
                                       result.displacements[static_cast<std::size_t>(own.nodes[0].index)])
                                          .head<3>());
      CHECK(stretch < 1e-5);
    }
  }
  CHECK(taut + slack == 2 * bays);
  CHECK(slack > 0);
  CHECK(result.equilibrium_error < 1e-10);
}

TEST_CASE("a tie that first order leaves slack is pulled taut by the sway that second order adds") {
  // A cantilever column under half of its critical load: its shortening slackens the tie by 1.5 times what the
  // first-order sway stretches it; the axial load about doubles the sway.
  const auto column = [](const std::string& axial) {
    return parse_model(R"({"topple": 1, "materials": {"steel": {"youngs_modulus": 2e11, "shear_modulus": 8e10}},
      "sections": {"post": {"area": 0.01, "Iy": 1e-5, "Iz": 1e-5, "J": 1e-5}, "tie": {"area": 1e-4, "Iy": 1e-9, "Iz": 1e-9, "J": 1e-9}},
      "joints": {"hinge": {"stiffness": {"ry": 0, "rz": 0}}},
      "nodes": {"foot": [0, 0, 0], "head": [0, 0, 4], "anchor": [-3, 0, 0]},
      "members": {"post": {"kind": "post", "nodes": ["foot", "head"], "section": "post", "material": "steel"},
        "tie": {"kind": "brace", "nodes": ["anchor", "head"], "section": "tie", "material": "steel", "axial": ")" +
                           axial + R"(", "joints": ["hinge", "hinge"]}},
      "supports": {"foot": "fixed", "anchor": "fixed"},
      "loads": {"all": {"nodes": {"head": {"x": 25.7, "z": -154e3}}}}})",
                       "column.json");
  };
  AnalysisRequest request;
  const CombinationResult first = analyse(column("tension"), request).combinations.front();
  CHECK_FALSE(first.members[1].active);
  request.second_order = topple::solver::SecondOrder::exact;
  const CombinationResult second = analyse(column("tension"), request).combinations.front();
  CHECK(second.members[1].active);
  CHECK(second.members[1].end_forces(6) > 0);
  CHECK(second.equilibrium_error < 1e-10);
  // Nothing of how the state was found is left in the answer.
  const CombinationResult both = analyse(column("both"), request).combinations.front();
  CHECK((second.displacements[1] - both.displacements[1]).norm() <= 1e-9 * both.displacements[1].norm());
}

TEST_CASE("a strut that second order would pull is slack in the second-order answer") {
  // The same column with a strut in the tie's place: first order presses it, the added sway would pull it.
  const Building building =
      parse_model(R"({"topple": 1, "materials": {"steel": {"youngs_modulus": 2e11, "shear_modulus": 8e10}},
      "sections": {"post": {"area": 0.01, "Iy": 1e-5, "Iz": 1e-5, "J": 1e-5}, "strut": {"area": 1e-6, "Iy": 1e-9, "Iz": 1e-9, "J": 1e-9}},
      "joints": {"hinge": {"stiffness": {"ry": 0, "rz": 0}}},
      "nodes": {"foot": [0, 0, 0], "head": [0, 0, 4], "anchor": [-3, 0, 0]},
      "members": {"post": {"kind": "post", "nodes": ["foot", "head"], "section": "post", "material": "steel"},
        "strut": {"kind": "brace", "nodes": ["anchor", "head"], "section": "strut", "material": "steel", "axial": "compression", "joints": ["hinge", "hinge"]}},
      "supports": {"foot": "fixed", "anchor": "fixed"},
      "loads": {"all": {"nodes": {"head": {"x": 25.7, "z": -154e3}}}}})",
                  "column.json");
  AnalysisRequest request;
  CHECK(analyse(building, request).combinations.front().members[1].active);
  request.second_order = topple::solver::SecondOrder::exact;
  const CombinationResult second = analyse(building, request).combinations.front();
  CHECK_FALSE(second.members[1].active);
  // The column alone: base moment H L tan(a)/a with a = L sqrt(P/EI).
  const double a = 4 * std::sqrt(154e3 / 2e6);
  CHECK(std::abs(second.members[0].end_forces(4)) == Approx(25.7 * 4 * std::tan(a) / a).epsilon(1e-6));
}
