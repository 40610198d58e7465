// Whatever the files hold, every reader gives a building or one clear line: none crashes, hangs or takes in nonsense.
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "formats/frame3dd.h"
#include "mutation.h"
#include "support/scratch_folder.h"
#include "support/shared_data.h"
#include "topple/structure/error.h"
#include "topple/structure/files.h"

using namespace topple::structure;
using topple::test::fuzz_rounds;
using topple::test::mutated;

namespace {

constexpr std::array<const char*, 19> table_values{"0",      "-1",      "1e308", "1e-308", "",     "nan", "A",
                                                   "1,5",    "\"1,5\"", "fixed", "B0",     "post", "x",   "=SUM(A1)",
                                                   "\"\"\"", "uniform", "2;3",   "1.5",    "dead"};
constexpr std::array<const char*, 12> number_values{"0",   "-1", "1e308", "-1e308", "1e-308", "nan",
                                                    "inf", "1",  "2",     "0.5",    "1e9",    "#"};

void check_sound(const Building& building) {
  for (const Member& member : building.members) {
    REQUIRE(member.length > 0);
    REQUIRE(std::isfinite(member.length));
    REQUIRE((member.axes * member.axes.transpose() - Mat3::Identity()).norm() < 1e-9);
  }
  for (const Node& node : building.nodes) REQUIRE(node.position.allFinite());
  for (const Section& section : building.sections) REQUIRE((section.area > 0 && section.J > 0));
  REQUIRE_FALSE(building.combinations.empty());
  REQUIRE(building.joints.size() == 2 * building.members.size() + 4 * building.panels.size());
}

/// Runs `read` on every round; counts what was refused in one line that begins with `name`.
template <class Read>
void fuzz(const std::string& name, Read read) {
  int accepted = 0, refused = 0;
  for (int round = 0; round < fuzz_rounds; ++round) {
    try {
      check_sound(read(round));
      ++accepted;
    } catch (const InputError& error) {
      const std::string what = error.what();
      REQUIRE(what.starts_with(name));
      REQUIRE(what.find('\n') == std::string::npos);
      ++refused;
    }
  }
  CHECK(accepted > fuzz_rounds / 200);  // the changes reach behind the syntax
  CHECK(refused > fuzz_rounds / 20);
}

const char* const frame3dd_model = R"(A post and a beam
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
1
1 1 2 3
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
2
1 0 1e-9 0 10
1
3 1 2 3 4
1
2 5
1
1
0
1 1
3 1 0 0 1 0 0
1 2
)";

const std::vector<std::pair<std::string, std::string>> tables{
    {"model.csv", "key,value\ntitle,Fuzz\nlength,m\nforce,kN\nmass,t\ngravity,9.8\n"},
    {"materials.csv", "name,youngs_modulus,poisson_ratio,density,thermal_expansion\nS,210e6,0.3,7.85,1.2e-5\n"},
    {"sections.csv",
     "name,shape,depth,width,thickness,area,Iy,Iz,J\nbox,box,0.3,0.2,0.01,,,,\nraw,,,,,0.01,1e-4,1e-4,1e-5\n"},
    {"joints.csv", "name,strength,tension,moment_y,rz\nj,1.5,100,20,\npin,,,,0\n"},
    {"nodes.csv", "name,x,y,z\nA0,0,0,0\nA1,0,0,3\nB0,6,0,0\nB1,6,0,3\n\"C,1\",6,6,3\nD1,0,6,3\n"},
    {"members.csv",
     "name,kind,node1,node2,section,material,upx,upy,upz,roll,joint1,joint2,groups\nPA,post,A0,A1,box,S,1,0,0,0.1,j,,g;"
     "h\n"
     "PB,post,B0,B1,raw,S,,,,,,,\nAB,beam,A1,B1,box,S,,,,,pin,pin,\n"},
    {"panels.csv",
     "name,kind,node1,node2,node3,node4,thickness,material,model,mesh,joint\nS1,slab,A1,B1,\"C,1\",D1,0.2,S,membrane,"
     "2x3,\n"},
    {"supports.csv", "node,x,y,z,rx,ry,rz\nA0,fixed,fixed,fixed,fixed,fixed,fixed\nB0,fixed,free,5e4,,,\n"},
    {"loads.csv",
     "case,on,name,type,component,value,value2,from,to,frame\ndead,model,,self_weight,,1,,,,\ndead,panel,S1,pressure,,"
     "1.5,,,,\n"
     "live,node,A1,force,z,-5,,,,\nlive,member,AB,uniform,z,-8,,,,projected\nlive,member,AB,trapezoid,z,-1,-4,1,3,"
     "local\n"
     "live,member,AB,point,y,2,,2.5,,\nlive,member,AB,temperature,uniform,20,,,,\nset,settlement,A0,settlement,z,-0.01,"
     ",,,\n"},
    {"combinations.csv", "name,case,factor\nall,dead,1.35\nall,live,1.5\n"}};

}  // namespace

TEST_CASE("mutated .3dd files give a sound building or one clear line") {
  std::mt19937 random(20140514);
  fuzz("m.3dd:", [&](int) { return parse_frame3dd(mutated(frame3dd_model, random, " \n", number_values), "m.3dd"); });
}

TEST_CASE("mutated tables give a sound building or one clear line") {
  std::mt19937 random(19990101);
  fuzz("m", [&](int round) {
    auto changed = tables;
    auto& [file, text] = changed[static_cast<std::size_t>(round) % changed.size()];
    text = mutated(text, random, ",\n", table_values);
    return parse_tables(changed, "m", Purpose::inspect);
  });
}

TEST_CASE("mutated tables with decimal commas give a sound building or one clear line") {
  std::mt19937 random(7);
  auto european = tables;
  for (auto& [file, text] : european)
    if (file != "members.csv" && file != "nodes.csv" && file != "panels.csv")
      for (char& c : text) c = c == ',' ? ';' : c == '.' ? ',' : c;
  fuzz("m", [&](int round) {
    auto changed = european;
    auto& [file, text] = changed[static_cast<std::size_t>(round) % changed.size()];
    text = mutated(text, random, ";\n", table_values);
    return parse_tables(changed, "m", Purpose::inspect);
  });
}

TEST_CASE("mutated scenarios give a scenario of its model or one clear line") {
  namespace fs = std::filesystem;
  const topple::test::ScratchFolder scratch;
  const fs::path& folder = scratch.path();
  std::ofstream(folder / "post.json")
      << R"({"topple": 1, "materials": {"s": {"youngs_modulus": 2e11, "poisson_ratio": 0.3, "density": 7850}},
    "sections": {"b": {"shape": "box", "depth": 0.3, "width": 0.2, "thickness": 0.01}}, "joints": {"j": {"capacity": {"tension": 1e6}}},
    "nodes": {"A": [0,0,0], "B": [0,0,3]}, "supports": {"A": "fixed"},
    "members": {"P": {"kind": "post", "nodes": ["A", "B"], "section": "b", "material": "s", "joints": ["j", null]}}})";
  const std::string scenario = R"({"topple": 1, "title": "Hit", "model": "post.json", "combination": "self weight",
    "step": 0.016666666666666666, "duration": 60, "until_rest": true, "seed": 1, "ground": 0.0,
    "failure": {"bracing": "classic", "mechanism": "detach", "generations_per_second": 240, "sudden": 2.0},
    "impact": {"restitution": 0.1, "structure_mass": true},
    "debris": {"friction": 0.6, "restitution": 0.1, "limit": 2000, "smallest_volume": 0.002}, "budget": {"operations": 5e8},
    "events": [{"at": 1.0, "projectile": {"from": [-20, 0, 2], "velocity": [60, 0, 0], "mass": 500, "radius": 0.4}},
      {"at": 2.0, "cut": {"joints": ["P:1"]}}, {"at": 3.0, "remove": {"members": ["P"], "panels": [], "supports": [], "groups": ["posts"]}},
      {"at": 4.0, "charge": {"centre": [0, 0, 1], "radius": 3, "strength": [0.0, 1.0]}},
      {"at": 7.0, "gravity": [0, 0, -9.80665]}, {"at": 8.0, "load": {"nodes": {"B": {"x": 1e5}}}}]})";
  constexpr std::array<const char*, 15> values{"0",      "-1", "1e308", "1e-308",  "null", "true", "\"P\"",
                                               "[]",     "{}", "\"\"",  "[0,0,0]", "1e9",  "0.5",  "\"post.json\"",
                                               "[\"*\"]"};
  std::mt19937 random(11);
  // The scenario is read before its model: what is wrong is told of one or the other, or that there is no such model.
  int accepted = 0, refused = 0;
  for (int round = 0; round < fuzz_rounds; ++round) {
    try {
      const auto [building, read] = parse_scenario(mutated(scenario, random, ":,}]", values), "s.json", folder);
      check_sound(building);
      REQUIRE((read.step > 0 && std::isfinite(read.step)));
      REQUIRE(read.duration > 0);
      ++accepted;
    } catch (const InputError& error) {
      REQUIRE(std::string(error.what()).find('\n') == std::string::npos);
      ++refused;
    }
  }
  CHECK(accepted > fuzz_rounds / 200);
  CHECK(refused > fuzz_rounds / 20);
  fs::remove_all(folder);
}
