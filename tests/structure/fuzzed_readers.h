#pragma once
// Whatever a file holds, every reader gives a sound building or one clear line: none crashes, hangs or takes in
// nonsense. Each function here changes a valid file at random so many times, the same way in every run.
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "formats/frame3dd/frame3dd.h"
#include "structure/example_model.h"
#include "structure/mutation.h"
#include "support/scratch_folder.h"
#include "topple/structure/error.h"
#include "topple/structure/formats/files.h"

namespace topple::test {

struct FuzzTally {
  int accepted = 0, refused = 0;
  std::string fault;  ///< of the first round that went wrong, with what it read; empty when none did
};

namespace fuzzed {

using structure::Building;
using structure::InputError;

inline constexpr std::array<const char*, 19> table_values{
    "0",  "-1",   "1e308", "1e-308",   "",       "nan",     "A",   "1,5", "\"1,5\"", "fixed",
    "B0", "post", "x",     "=SUM(A1)", "\"\"\"", "uniform", "2;3", "1.5", "dead"};
inline constexpr std::array<const char*, 12> number_values{"0",   "-1", "1e308", "-1e308", "1e-308", "nan",
                                                           "inf", "1",  "2",     "0.5",    "1e9",    "#"};

/// What is wrong with a building that a reader has accepted; empty: nothing.
inline std::string unsound(const Building& building) {
  for (const structure::Member& member : building.members) {
    if (!(member.length > 0) || !std::isfinite(member.length)) return "length of member " + member.name;
    if (!((member.axes * member.axes.transpose() - structure::Mat3::Identity()).norm() < 1e-9))
      return "axes of member " + member.name;
  }
  for (const structure::Node& node : building.nodes)
    if (!node.position.allFinite()) return "place of node " + node.name;
  for (const structure::Section& section : building.sections)
    if (!(section.area > 0 && section.J > 0)) return "a section without area or J";
  for (const structure::Panel& panel : building.panels)
    if (!(panel.thickness > 0)) return "thickness of panel " + panel.name;
  if (building.combinations.empty()) return "no combination";
  if (building.joints.size() != 2 * building.members.size() + 4 * building.panels.size()) return "number of joints";
  return {};
}

/// `text` gives what to read, `read` reads it and tells what is wrong with what it took; `opening`: how every refusal
/// begins.
inline FuzzTally run(int rounds, const std::string& opening, const std::function<std::string(int)>& text,
                     const std::function<std::string(const std::string&, int)>& read) {
  FuzzTally tally;
  for (int round = 0; round < rounds && tally.fault.empty(); ++round) {
    const std::string changed = text(round);
    std::string fault;
    try {
      fault = read(changed, round);
      ++tally.accepted;
    } catch (const InputError& error) {
      const std::string what = error.what();
      if (!what.starts_with(opening)) fault = "the message does not begin with " + opening + ": " + what;
      if (what.find('\n') != std::string::npos) fault = "the message has several lines: " + what;
      ++tally.refused;
    } catch (const std::exception& error) {
      fault = std::string("ends with: ") + error.what();
    }
    if (!fault.empty()) tally.fault = "round " + std::to_string(round) + ": " + fault + "\n" + changed;
  }
  return tally;
}

inline const char* const frame3dd_model = R"(A post and a beam
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

using Tables = std::vector<std::pair<std::string, std::string>>;
inline const Tables tables{
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
    {"restraints.csv", "member,at\nPA,1.5\nPA,2.25\n"},
    {"openings.csv", "panel,opening,x,y\nS1,1,1.5,1\nS1,1,2.5,1\nS1,1,2.5,2.25\nS1,b,3,3\nS1,b,4,3\nS1,b,4,4.5\n"},
    {"diaphragms.csv", "name,node\nlevel,A1\nlevel,B*1\n"},
    {"masses.csv",
     "on,name,value,Ixx,Iyy,Izz\nnode,A1,1.5,,,\nnode,B1,2,1,1.5,2\nmember,AB,0.7,,,\nload,dead,0.5,,,\n"},
    {"supports.csv", "node,x,y,z,rx,ry,rz\nA0,fixed,fixed,fixed,fixed,fixed,fixed\nB0,fixed,free,5e4,,,\n"},
    {"loads.csv",
     "case,on,name,type,component,value,value2,from,to,frame\ndead,model,,self_weight,,1,,,,\ndead,panel,S1,pressure,,"
     "1.5,,,,\n"
     "live,node,A1,force,z,-5,,,,\nlive,member,AB,uniform,z,-8,,,,projected\nlive,member,AB,trapezoid,z,-1,-4,1,3,"
     "local\n"
     "live,member,AB,point,y,2,,2.5,,\nlive,member,AB,temperature,uniform,20,,,,\nset,settlement,A0,settlement,z,-0.01,"
     ",,,\n"},
    {"combinations.csv", "name,case,factor\nall,dead,1.35\nall,live,1.5\n"}};

inline const std::string generator_model =
    R"({"topple": 1, "materials": {"m": {"youngs_modulus": 2e11, "poisson_ratio": 0.3}},
  "sections": {"s": {"shape": "box", "depth": 0.3, "width": 0.2, "thickness": 0.01}},
  "loads": {"dead": {"self_weight": 1}},
  "building": {"name": "A", "posts": [2, 3], "storeys": 2, "bay": [6, [5, 6]], "storey_height": [4, 3], "omit": ["P-1-2-*"],
    "post": [{"storeys": [1, 2], "section": "s", "material": "m"}], "beam": {"section": "s", "material": "m", "groups": ["g"]},
    "slab": {"thickness": 0.2, "material": "m", "pressure": {"dead": 1000}},
    "wall": {"thickness": 0.1, "material": "m", "sides": ["x-", "y2"]}}})";

/// One random change: a character, a piece moved over another, a piece dropped, a number made extreme.
inline std::string mutated_model(std::string text, std::mt19937& random) {
  const auto below = [&](std::size_t n) { return static_cast<std::size_t>(random() % n); };
  static const char alphabet[] = "{}[]\",:0123456789.-eE+ntfxyz*\\/ \n";
  static const char* const values[] = {"0",    "-1",        "1e308",  "-1e308", "1e-308", "null",
                                       "true", "\"fixed\"", "[]",     "{}",     "\"\"",   "[0,0,0]",
                                       "1e9",  "0.5",       "\"A0\"", "2",      "[1,2]",  "\"I\""};
  switch (below(5)) {
    case 0:
      text[below(text.size())] = alphabet[below(sizeof alphabet - 1)];
      break;
    case 1:
      text.erase(below(text.size()), below(30));
      break;
    case 2:
      text.insert(below(text.size()), text.substr(below(text.size()), below(60)));
      break;
    default: {  // the value after some colon or comma
      const std::size_t at = text.find_first_of(":,", below(text.size()));
      if (at == std::string::npos) break;
      const std::size_t end = text.find_first_of(",}]", at + 1);
      if (end == std::string::npos) break;
      text.replace(at + 1, end - at - 1, values[below(std::size(values))]);
    }
  }
  return text;
}

/// Changes one of the tables in each round, all in turn.
inline FuzzTally run_tables(int rounds, const Tables& whole, unsigned seed, const char* separators) {
  std::mt19937 random(seed);
  const auto file = [&](int round) { return static_cast<std::size_t>(round) % whole.size(); };
  return run(
      rounds, "m", [&](int round) { return mutated(whole[file(round)].second, random, separators, table_values); },
      [&](const std::string& text, int round) {
        Tables changed = whole;
        changed[file(round)].second = text;
        return unsound(structure::parse_tables(changed, "m", structure::Purpose::inspect));
      });
}

}  // namespace fuzzed

inline FuzzTally fuzz_models(int rounds) {
  using namespace fuzzed;
  std::mt19937 random(20240229);
  const auto text = [&](int round) {
    std::string changed = round % 2 == 0 ? example_model : generator_model;
    for (std::size_t changes = 1 + random() % 3; changes > 0; --changes)
      changed = mutated_model(std::move(changed), random);
    return changed;
  };
  return run(rounds, "m.json, line ", text, [](const std::string& changed, int) {
    return unsound(structure::parse_model(changed, "m.json", structure::Purpose::inspect));
  });
}

inline FuzzTally fuzz_frame3dd(int rounds) {
  using namespace fuzzed;
  std::mt19937 random(20140514);
  return run(
      rounds, "m.3dd:", [&](int) { return mutated(frame3dd_model, random, " \n", number_values); },
      [](const std::string& text, int) { return unsound(structure::parse_frame3dd(text, "m.3dd")); });
}

inline FuzzTally fuzz_tables(int rounds) { return fuzzed::run_tables(rounds, fuzzed::tables, 19990101, ",\n"); }

/// With semicolons between cells and decimal commas.
inline FuzzTally fuzz_european_tables(int rounds) {
  fuzzed::Tables european = fuzzed::tables;
  for (auto& [file, text] : european)
    if (file != "members.csv" && file != "nodes.csv" && file != "panels.csv")
      for (char& c : text) c = c == ',' ? ';' : c == '.' ? ',' : c;
  return fuzzed::run_tables(rounds, european, 7, ";\n");
}

/// A scenario is read before its model: what is wrong is told of one or the other, or that there is no such model.
inline FuzzTally fuzz_scenarios(int rounds) {
  using namespace fuzzed;
  const ScratchFolder scratch;
  const std::filesystem::path& folder = scratch.path();
  std::ofstream(folder / "post.json")
      << R"({"topple": 1, "materials": {"s": {"youngs_modulus": 2e11, "poisson_ratio": 0.3, "density": 7850}},
    "sections": {"b": {"shape": "box", "depth": 0.3, "width": 0.2, "thickness": 0.01}}, "joints": {"j": {"capacity": {"tension": 1e6}}},
    "nodes": {"A": [0,0,0], "B": [0,0,3]}, "supports": {"A": "fixed"},
    "members": {"P": {"kind": "post", "nodes": ["A", "B"], "section": "b", "material": "s", "joints": ["j", null]}}})";
  const std::string scenario =
      R"({"topple": 1, "title": "Hit", "model": "post.json", "standing": "static", "combination": "self weight",
    "step": 0.016666666666666666, "duration": 60, "until_rest": true, "seed": 1, "ground": 0.0,
    "failure": {"bracing": "classic", "mechanism": "detach", "sudden": 2.0},
    "impact": {"restitution": 0.1, "structure_mass": true},
    "debris": {"friction": 0.6, "restitution": 0.1, "limit": null, "smallest_volume": 0.002},
    "events": [{"at": 1.0, "projectile": {"from": [-20, 0, 2], "velocity": [60, 0, 0], "mass": 500, "radius": 0.4}},
      {"at": 2.0, "cut": {"joints": ["P:1"]}}, {"at": 3.0, "remove": {"members": ["P"], "panels": [], "supports": [], "groups": ["posts"]}},
      {"at": 4.0, "charge": {"centre": [0, 0, 1], "radius": 3, "strength": [0.0, 1.0]}},
      {"at": 7.0, "gravity": [0, 0, -9.80665]}, {"at": 8.0, "load": {"nodes": {"B": {"x": 1e5}}}}]})";
  constexpr std::array<const char*, 15> values{"0",      "-1", "1e308", "1e-308",  "null", "true", "\"P\"",
                                               "[]",     "{}", "\"\"",  "[0,0,0]", "1e9",  "0.5",  "\"post.json\"",
                                               "[\"*\"]"};
  std::mt19937 random(11);
  return run(
      rounds, "", [&](int) { return mutated(scenario, random, ":,}]", values); },
      [&](const std::string& text, int) -> std::string {
        const auto [building, read] = structure::parse_scenario(text, "s.json", folder);
        if (!(read.step > 0 && std::isfinite(read.step) && read.duration > 0)) return "its step or its duration";
        return unsound(building);
      });
}

}  // namespace topple::test
