// Buildings from places on a plan: what rules choose, and what is refused.
#include <algorithm>
#include <catch2/catch.hpp>

#include "topple/structure/error.h"
#include "topple/structure/formats/files.h"

using namespace topple::structure;

namespace {

std::string with(const std::string& building) {
  return R"({"topple": 1, "materials": {"s": {"youngs_modulus": 2.1e11, "poisson_ratio": 0.3, "density": 7850}},
    "sections": {"c": {"catalogue": "HEB200"}, "d": {"catalogue": "HEB300"}}, "loads": {"dead": {"self_weight": 1}},
    "combinations": {"all": {"dead": 1}}, "building": )" +
         building + "}";
}

constexpr const char* tower = R"({"name": "T", "origin": [10, 20, 1],
  "places": {"A": [0, 0], "B": [6, 0], "C": [3, 5]}, "storeys": 3, "storey_height": [4, 3, 3],
  "post": [{"places": ["A", "B"], "section": "c", "material": "s"},
           {"places": ["C*"], "storeys": [1, 2], "section": "d", "material": "s", "groups": ["tip"]}],
  "beam": [{"between": [["A", "B", "C", "A"]], "storeys": [1, 2], "section": "c", "material": "s", "load": {"dead": 5000}}],
  "base": "fixed"})";

std::string refusal(std::string building, const std::string& from, const std::string& to) {
  const std::size_t at = building.find(from);
  REQUIRE(at != std::string::npos);
  building.replace(at, from.size(), to);
  try {
    (void)parse_model(with(building), "m.json");
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

}  // namespace

TEST_CASE("posts and beams stand where the rules for places and storeys say, and beams carry their weight") {
  const Building building = parse_model(with(tower), "m.json");
  // Two posts over three storeys and one over two; a ring of three beams on two of them.
  CHECK(building.members.size() == 3 + 3 + 2 + 2 * 3);
  const auto top = std::max_element(building.nodes.begin(), building.nodes.end(),
                                    [](const Node& a, const Node& b) { return a.position.z() < b.position.z(); });
  CHECK(top->position.z() == 1 + 4 + 3 + 3);
  double posts = 0, beams = 0, tip = 0;
  for (const Member& member : building.members) {
    (member.kind == MemberKind::post ? posts : beams) += member.length;
    if (building[member.section].area > 0.01) tip += member.length;
  }
  CHECK(posts == Approx(10 + 10 + 7));
  CHECK(beams == Approx(2 * (6 + 2 * std::sqrt(9.0 + 25.0))));
  CHECK(tip == Approx(7));
  const LoadCase& dead = building.cases.front();
  double weight = 0;
  for (const MemberLoad& load : dead.members) weight -= load.first(2) * (load.to - load.from);
  CHECK(weight == Approx(5000 * beams));
}

TEST_CASE("a plan that contradicts itself is refused with what is accepted") {
  CHECK(refusal(tower, R"("T")", R"("T*")").find("holds no *") != std::string::npos);
  CHECK(refusal(tower, R"("A": [0, 0])", R"("": [0, 0])").find("a place's name is empty") != std::string::npos);
  CHECK(refusal(tower, R"({"A": [0, 0], "B": [6, 0], "C": [3, 5]})", "{}").find("no places") != std::string::npos);
  CHECK(refusal(tower, R"("C*")", R"("D*")").find("no further place is named like \"D*\"") != std::string::npos);
  CHECK(refusal(tower, R"("A", "B", "C", "A")", R"("A", "Q")").find("there is no place \"Q\"") != std::string::npos);
  for (const auto& [from, to] : {std::pair{"[4, 3, 3]", "[4, 3]"},
                                 {"[4, 3, 3]", "[4, 0, 3]"},
                                 {"[4, 3, 3]", "-1"},
                                 {"[1, 2]", "[2, 1]"},
                                 {"[1, 2]", "[1, 9]"},
                                 {"[1, 2]", "[1]"},
                                 {R"("storeys": 3)", R"("storeys": 0)"},
                                 {"[6, 0]", "[6]"},
                                 {"{\"dead\"", "{\"snow\""}}) {
    CAPTURE(from, to);
    CHECK(refusal(tower, from, to).find("accepted") != std::string::npos);
  }
}
