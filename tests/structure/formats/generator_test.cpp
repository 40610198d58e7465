// The building generator: counts, names, places, normals, groups and what is left out, as the format says.
#include <Eigen/Geometry>
#include <algorithm>
#include <catch2/catch.hpp>

#include "example_model.h"
#include "topple/structure/error.h"
#include "topple/structure/formats/files.h"

using namespace topple::structure;
using topple::test::replaced;

namespace {

const std::string text = R"({"topple": 1,
  "materials": {"S355": {"youngs_modulus": 2e11, "poisson_ratio": 0.3}, "C30": {"youngs_modulus": 3e10, "poisson_ratio": 0.2}},
  "sections": {"col": {"shape": "box", "depth": 0.3, "width": 0.3, "thickness": 0.01},
               "tube": {"shape": "box", "depth": 0.2, "width": 0.2, "thickness": 0.01},
               "w14": {"catalogue": "w14X48"}},
  "joints": {"given": {"capacity": {"tension": 1e6}}, "edge": {"capacity_per_length": {"shear_z": 1e5}}},
  "loads": {"dead": {"self_weight": 1}, "live": {}},
  "building": {
    "name": "A", "origin": [10, 20, 1], "posts": [4, 5], "storeys": 6, "bay": [6.0, [6, 7, 7, 6]],
    "storey_height": [4.5, 3.5, 3.5, 3.5, 3.5, 3.5],
    "post": [{"storeys": [1, 3], "section": "col", "material": "S355", "joint": "given"},
             {"storeys": [4, 6], "section": "tube", "material": "S355", "joint": "given"}],
    "beam": {"section": "w14", "material": "S355", "joint": "given", "groups": ["floors"]},
    "slab": {"thickness": 0.2, "material": "C30", "joint": "edge", "model": "membrane", "pressure": {"dead": 1500, "live": 3000}},
    "wall": {"thickness": 0.15, "material": "C30", "joint": "edge", "model": "cladding", "sides": ["x-", "x+", "y-", "y+", "x2"]},
    "omit": ["P-2-2-*"], "base": "fixed"}})";

Building read(const std::string& model) { return parse_model(model, "m.json", Purpose::inspect); }

std::string error(const std::string& from, const std::string& to) {
  try {
    (void)read(replaced(text, from, to));
  } catch (const InputError& problem) {
    return problem.what();
  }
  return "no error";
}

Vec3 centre(const Building& building, const Panel& panel) {
  Vec3 sum = Vec3::Zero();
  for (const NodeId node : panel.nodes) sum += building[node].position;
  return sum / 4;
}

}  // namespace

TEST_CASE("the format's building has its parts, counted by hand") {
  const Building building = read(text);
  const NameIndex names(building);
  CHECK(names.group("posts")->members.size() == 4 * 5 * 6 - 6);
  CHECK(names.group("beams")->members.size() == (3 * 5 + 4 * 4) * 6);
  CHECK(names.group("slabs")->panels.size() == 3 * 4 * 6);
  CHECK(names.group("walls")->panels.size() == (3 * 4 + 2 * 3) * 6);  // x-, x+, x2 of 4 bays, y-, y+ of 3
  // N-2-2-0 is attached to the wall on line x2 alone, so it is there.
  CHECK(building.nodes.size() == 4 * 5 * 7);
  CHECK(building.supports.size() == 20);
  CHECK(names.group("A")->members.size() == building.members.size());
  CHECK(names.group("floors")->members.size() == 186);
  CHECK(names.group("storey-6")->members.size() == 19 + 31);
  CHECK(names.group("storey-6")->panels.size() == 12 + 18);
}

TEST_CASE("a node lasts as long as anything is attached to it") {
  const Building building = read(replaced(text, R"(, "x2"])", "]"));
  const NameIndex names(building);
  CHECK_FALSE(names.node("A/N-2-2-0"));
  CHECK(names.node("A/N-2-2-1"));  // beams hang on it
  CHECK(building.supports.size() == 19);
}

TEST_CASE("generated parts lie where lines and levels meet") {
  const Building building = read(text);
  const NameIndex names(building);
  const auto place = [&](const std::string& name) { return building[names.node(name).value()].position; };
  CHECK((place("A/N-1-1-0") - Vec3(10, 20, 1)).norm() == 0);
  CHECK((place("A/N-4-5-6") - Vec3(10 + 18, 20 + 26, 1 + 4.5 + 5 * 3.5)).norm() < 1e-12);
  CHECK((place("A/N-2-3-2") - Vec3(16, 33, 9)).norm() < 1e-12);
  const Member& post = building[names.member("A/P-3-4-5").value()];
  CHECK(building[post.nodes[0]].name == "A/N-3-4-4");  // first end at the bottom
  CHECK(building[post.nodes[1]].name == "A/N-3-4-5");
  CHECK(building[post.section].name == "tube");
  CHECK(post.kind == MemberKind::post);
  const MemberId id = *names.member("A/P-3-4-5");
  CHECK(building[building.joint(id, 0)].capacity.breakable);
  CHECK_FALSE(building[building.joint(id, 1)].capacity.breakable);
  const Member& bx = building[names.member("A/BX-3-4-5").value()];
  CHECK(building[bx.nodes[1]].name == "A/N-4-4-5");
  const Member& by = building[names.member("A/BY-3-4-5").value()];
  CHECK(building[by.nodes[1]].name == "A/N-3-5-5");
  CHECK(building[building.joint(*names.member("A/BY-3-4-5"), 1)].capacity.breakable);
  CHECK(building[names.member("A/P-3-4-3").value()].section == SectionId(0));
}

TEST_CASE("slabs face up and walls outwards, inner ones towards +x") {
  const Building building = read(text);
  Vec3 middle = Vec3::Zero();
  for (const Node& node : building.nodes) middle += node.position / static_cast<double>(building.nodes.size());
  for (const Panel& panel : building.panels) {
    CAPTURE(panel.name);
    const Vec3 normal = panel.axes.row(2);
    if (panel.kind == PanelKind::slab) {
      CHECK((normal - Vec3::UnitZ()).norm() < 1e-15);
    } else {
      CHECK(std::abs(normal.z()) < 1e-15);
      const bool inner = panel.name.starts_with("A/WY-2-");
      if (inner) CHECK((normal - Vec3::UnitX()).norm() < 1e-15);
      Vec3 out = centre(building, panel) - middle;
      out.z() = 0;
      if (!inner) CHECK(normal.dot(out) > 0);
      // k of a wall's name is the level of its top.
      double top = 0;
      for (const NodeId node : panel.nodes) top = std::max(top, building[node].position.z());
      const int k = panel.name.back() - '0';
      CHECK(top == Approx(1 + 4.5 + (k - 1) * 3.5));
    }
  }
}

TEST_CASE("a slab's pressures stand in their cases") {
  const Building building = read(text);
  REQUIRE(building.cases[1].panels.size() == 72);
  CHECK(building.cases[1].panels[5].pressure == 3000);
  CHECK(building.cases[0].panels[5].pressure == 1500);
}

TEST_CASE("several buildings stand side by side, their parts within reach of the file's own") {
  std::string two = replaced(text, "\"building\": {",
                             "\"nodes\": {\"X\": [10, 46, 30]}, \"members\": {\"mast\": {\"nodes\": [\"A/N-1-5-6\", "
                             "\"X\"], \"section\": \"tube\", \"material\": \"S355\"}}, \"buildings\": [{");
  two.pop_back();
  two += R"(, {"name": "B", "origin": [100, 0, 0], "posts": [1, 1], "storeys": 2, "bay": [6, 6], "storey_height": 3,
    "post": {"section": "col", "material": "S355"}, "beam": {"section": "w14", "material": "S355"}, "base": "pinned"}]})";
  const Building building = read(two);
  const NameIndex names(building);
  CHECK(names.group("B")->members.size() == 2);
  CHECK(names.member("mast"));
  CHECK(building.supports.back().stiffness[3] == 0);
  CHECK(names.members_matching("B/P-*").size() == 2);
}

TEST_CASE("mistakes in a generator are told by their place") {
  CHECK(error("[6, 7, 7, 6]", "[6, 7, 7]") ==
        "m.json, line 9, building.bay[1]: found an array of 3; accepted: an array of 4");
  CHECK(error("\"storeys\": [4, 6]", "\"storeys\": [3, 6]") ==
        "m.json, line 12, building.post[1]: storey 3 has a post already; accepted: one for each storey");
  CHECK(error("\"storeys\": [4, 6]", "\"storeys\": [5, 6]") ==
        "m.json, line 11, building.post: storey 4 has no post; accepted: one for each storey");
  CHECK(error("\"x2\"", "\"x4\"") ==
        "m.json, line 15, building.wall.sides: there is no side \"x4\"; accepted: \"x-\", \"x+\", \"y-\", \"y+\", "
        "inner lines "
        "x2 to x3 and y2 to y4");
  CHECK(error("\"P-2-2-*\"", "\"Q-2-2-*\"") ==
        "m.json, line 16, building.omit[0]: nothing is named like \"Q-2-2-*\"; accepted: names of posts, beams, slabs "
        "or walls");
  CHECK(error("\"live\": 3000", "\"snow\": 3000") ==
        "m.json, line 14, building.slab.pressure.snow: there is no load case \"snow\"; accepted: \"dead\", \"live\"");
  const std::string too_many = error("\"posts\": [4, 5]", "\"posts\": [10000, 10000]");
  CHECK(too_many.find("building.posts: the model would have ") != std::string::npos);
  CHECK(too_many.ends_with(" nodes, members and panels; accepted: at most 4000000"));
  CHECK(error("\"base\"", "\"bass\"").find("building.bass: unknown key") != std::string::npos);
}

TEST_CASE("rules of a building by places take what a design check needs to know") {
  const Building b = parse_model(R"({"topple": 1,
    "materials": {"S": {"youngs_modulus": 210e9, "poisson_ratio": 0.3}},
    "sections": {"s": {"catalogue": "HEB300"}},
    "building": {"places": {"A": [0, 0], "B": [6, 0]}, "storeys": 2, "storey_height": 3.5,
      "post": {"section": "s", "material": "S", "design": {"factor_y": 1, "length_z": 2}},
      "beam": {"between": [["A", "B"]], "section": "s", "material": "S", "design": {"restraints": "continuous"}}}})",
                                 "plan.json");
  for (const Member& member : b.members) {
    const bool post = member.kind == MemberKind::post;
    CHECK(member.design.factors[0].has_value() == post);
    if (post) CHECK(*member.design.lengths[1] == 2);
    CHECK(member.design.restrained_throughout == !post);
  }
}
