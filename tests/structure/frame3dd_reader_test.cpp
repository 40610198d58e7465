// The .3dd reader: what it makes of the published examples, and where it says that a file is wrong.
#include <catch2/catch.hpp>
#include <fstream>
#include <sstream>

#include "formats/frame3dd.h"
#include "support/shared_data.h"
#include "topple/structure/error.h"

using namespace topple::structure;

namespace {

const char* const two_posts = R"(A post and a beam
3                    # nodes
1  0 0 0   0
2  0 0 3000 0
3  2000 0 3000 0.0
1                    # reactions
1  1 1 1 1 1 1
2                    # elements
1 1 2  100 50 60 10 20 30 200000 80000 0   7.85e-9
2 2 3  100 50 60 10 20 30 200000 80000 90. 7.85e-9
1
0
1 1 -1
1
0 0 -9806.65
1
3  0 0 -1000 0 0 0
0
1
2  0 0 0 0
   500 1500 0.1 0.2
   0 0 0 0
1
2 0 -5 0 2000
1
1 12e-6 100 200  10 20 30 70
1
1 0 0 -2.5 0 0 0
0
)";

std::string read_shared(const std::string& file) {
  std::ifstream stream(topple::test::shared_path(file));
  std::stringstream text;
  text << stream.rdbuf();
  return text.str();
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  text.replace(text.find(from), from.size(), to);
  return text;
}

std::string message(const std::string& text) {
  try {
    (void)parse_frame3dd(text, "f.3dd");
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

}  // namespace

TEST_CASE("a .3dd file keeps its numbers, names, axes and loads") {
  const Building building = parse_frame3dd(two_posts, "f.3dd");
  CHECK(building.title == "A post and a beam");
  CHECK(building.units.consistent);
  REQUIRE(building.nodes.size() == 3);
  REQUIRE(building.members.size() == 2);
  CHECK(building.joints.size() == 4);
  CHECK(building.sections.size() == 1);
  CHECK(building.sections[0].Iy == 20);
  CHECK(building.sections[0].Iz == 30);
  CHECK(building.sections[0].shear_area_z == 60);
  // Vertical and pointing up: y = +Y, z = -X, as Frame3DD has it.
  CHECK(building.members[0].axes.row(1).transpose().isApprox(Vec3(0, 1, 0)));
  CHECK(building.members[0].axes.row(2).transpose().isApprox(Vec3(-1, 0, 0)));
  // Horizontal, rolled by 90 degrees: y was +Y and is now up.
  CHECK((building.members[1].axes.row(1).transpose() - Vec3(0, 0, 1)).norm() < 1e-15);
  CHECK(building.gravity == 9806.65);
  const LoadCase& load_case = building.cases.at(0);
  CHECK(load_case.self_weight == Vec3(0, 0, -1));
  REQUIRE(load_case.members.size() == 3);
  CHECK(load_case.members[0].kind == MemberLoad::Kind::distributed);
  CHECK(load_case.members[0].from == 500);
  CHECK(load_case.members[0].last[1] == 0.2);
  CHECK(load_case.members[1].kind == MemberLoad::Kind::point);
  CHECK(load_case.members[1].from == 2000);
  CHECK(load_case.members[2].temperature == 32.5);
  CHECK(load_case.members[2].gradient_y == Approx(-0.1));
  CHECK(load_case.members[2].gradient_z == Approx(-0.2));
  REQUIRE(load_case.settlements.size() == 1);
  CHECK(load_case.settlements[0].value == -2.5);
  CHECK(building.combinations.at(0).name == "case 1");
}

TEST_CASE("without the shear flag a .3dd file's shear areas do not count") {
  const Building building = parse_frame3dd(replaced(two_posts, "\n1\n0\n1 1 -1", "\n0\n1\n1 1 -1"), "f.3dd");
  CHECK(building.sections[0].shear_area_y == 0);
  CHECK(building.requested.cubic_p_delta);
}

TEST_CASE("a wrong .3dd file is refused with the line and what is accepted") {
  CHECK(message(replaced(two_posts, "2  0 0 3000 0", "1  0 0 3000 0")) == "f.3dd:4: node 1 is given twice");
  CHECK(message(replaced(two_posts, "3  2000", "3  nan")) ==
        "f.3dd:5: x of node 3: found 'nan', accepted is a finite number");
  CHECK(message(replaced(two_posts, "2 2 3  100", "2 2 7  100")) ==
        "f.3dd:10: node 2 of element 2: found 7, accepted is a whole number from 1 to 3");
  CHECK(message(replaced(two_posts, "2 2 3  100", "2 2 2  100")) == "f.3dd:10: element 2 has no length");
  CHECK(message(replaced(two_posts, "3                    # nodes", "3000000 # nodes")) ==
        "f.3dd:2: the number of nodes: found 3000000, more than the rest of the file holds");
  CHECK_THAT(message(replaced(two_posts, "2 0 -5 0 2000", "2 0 -5 0 2001")),
             Catch::Contains("a load lies beyond the end of element 2"));
  CHECK_THAT(message(replaced(two_posts, "1 0 0 -2.5 0 0 0", "2 0 0 -2.5 0 0 0")), Catch::Contains("no reaction"));
  CHECK(message("only a title\n") == "f.3dd:1: the file ends where the number of nodes is expected");
}

TEST_CASE("the published .3dd examples are read whole") {
  if (!topple::test::have_shared("reference/frame3dd/exE.3dd")) return;
  const Building a = parse_frame3dd(read_shared("reference/frame3dd/exA.3dd"), "exA.3dd");
  CHECK(a.nodes.size() == 12);
  CHECK(a.combinations.size() == 2);
  CHECK(a.cases[1].members.size() == 3);
  const Building e = parse_frame3dd(read_shared("reference/frame3dd/exE.3dd"), "exE.3dd");
  CHECK(e.requested.modes == 4);
  CHECK(e.masses.nodes.at(0).inertia.z() == 839.37);
  CHECK_THAT(e.warnings.at(0), Catch::Contains("condensation"));
  const Building h = parse_frame3dd(read_shared("reference/frame3dd/exH.3dd"), "exH.3dd");
  CHECK(h.members.size() == 295);
  CHECK(h.masses.members.size() == 163);
}
