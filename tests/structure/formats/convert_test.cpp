// Conversion between JSON, .3dd and tables: a round trip keeps every number to the bit, and what the target cannot hold
// is refused by its name.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "formats/frame3dd/frame3dd_file.h"
#include "formats/model_files.h"
#include "support/scratch_folder.h"
#include "support/shared_data.h"
#include "topple/structure/analysis.h"
#include "topple/structure/error.h"
#include "topple/structure/formats/convert.h"
#include "topple/structure/formats/files.h"

using namespace topple::structure;

namespace {

namespace fs = std::filesystem;

class Scratch : public topple::test::ScratchFolder {
 public:
  fs::path write(const std::string& name, const std::string& text) const {
    const fs::path file = *this / name;
    fs::create_directories(file.parent_path());
    std::ofstream(file, std::ios::binary) << text;
    return file;
  }
  /// Converts and writes; returns where.
  fs::path convert(const fs::path& in, const std::string& out) const {
    const ModelForm form = model_form(*this / out);
    for (const auto& [name, text] : convert_model(in, form).files)
      write(form == ModelForm::tables ? out + "/" + name : out, text);
    return *this / out;
  }
};

std::string message(const Scratch& scratch, const fs::path& in, const std::string& out) {
  try {
    scratch.convert(in, out);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

/// With everything that tables hold; numbers without a short binary form, to the last bit.
const std::string full_model = R"({"topple": 1, "title": "All, of \"it\"; tables", "gravity": 9.81000000000000049,
 "units": {"length": "mm", "force": "kN", "mass": "t"},
 "materials": {"S 355": {"youngs_modulus": 210.00000000000003, "poisson_ratio": 0.3, "density": 7.85e-9, "yield_strength": 0.355,
   "thermal_expansion": 1.2e-5}, "C,30": {"youngs_modulus": 33.1, "shear_modulus": 13.75, "poisson_ratio": 0.2, "tensile_strength": 0.0029, "thermal_expansion": 1e-5}},
 "sections": {"I": {"shape": "I", "depth": 300.1, "width": 300, "web": 11, "flange": 19, "fillet": 27, "shear_deformation": false},
   "pipe": {"shape": "pipe", "diameter": 219.1, "thickness": 6.3}, "w": {"catalogue": "W14x48"},
   "raw": {"area": 0.1e5, "Iy": 1e8, "Iz": 1e7, "J": 1e6, "shear_area_y": 4000.000000000001, "torsion_modulus": 2e4, "depth": 300, "width": 200}},
 "joints": {"pin": {"stiffness": {"ry": 0, "rz": 0}}, "j": {"capacity": {"tension": 2e3, "moment_y": 6.1e5}, "strength": 1.1, "stiffness": {"rx": 4.7e7}}},
 "nodes": {"A0": [0, 0, 0], "A1": [0, 0, 3500.1], "B0": [6000, 0, 0], "B1": [6000, 0, 3500.1], "C0": [6000, 6000, 0.1e-3],
           "C1": [6000, 6000, 3500.1], "D1": [0, 6000, 3500.1]},
 "members": {"PA": {"kind": "post", "nodes": ["A0", "A1"], "section": "I", "material": "S 355", "up": [0.1, 0.7, 0], "roll": 0.30000000000000004,
   "joints": ["j", null], "groups": ["west", "first floor"]},
   "PB": {"kind": "post", "nodes": ["B0", "B1"], "section": "pipe", "material": "S 355", "design": "none"},
   "PC": {"kind": "post", "nodes": ["C0", "C1"], "section": "raw", "material": "S 355", "design": {"factor_y": 2.1, "length_z": 3100.7,
     "restraints": [1000.3, 2000.1], "moment_factor": 1.13}},
   "AB": {"nodes": ["A1", "B1"], "section": "w", "material": "S 355", "joints": ["pin", "pin"]},
   "BC": {"nodes": ["B1", "C1"], "section": "w", "material": "S 355", "design": {"restraints": "continuous", "equivalent_moment_z": 0.9, "stiffener_spacing": 1.25}}, "CD": {"nodes": ["C1", "D1"], "section": "w", "material": "S 355"},
   "DA": {"nodes": ["D1", "A1"], "section": "w", "material": "S 355"}},
 "panels": {"S1": {"kind": "slab", "nodes": ["A1", "B1", "C1", "D1"], "thickness": 200.7, "material": "C,30", "model": "membrane", "mesh": [4, 3],
   "openings": [[[1000.1, 700], [2000, 700], [2000, 1500.3]], [[3000, 3000], [3500, 3000], [3500, 4000.7], [3000, 4000.7]]]}},
 "diaphragms": {"level, 1": ["B1", "C*1"], "other": ["D1"]},
 "masses": {"nodes": {"A1": 1.7, "B1": [0.3, 1e3, 2e3, 3000.1]}, "members": {"AB": 0.45}, "loads": {"dead": 0.30000000000000004}},
 "supports": {"A0": "fixed", "B0": "pinned", "C0": {"x": true, "y": true, "z": 50.3}},
 "loads": {"dead": {"self_weight": 1.1, "panels": {"S1": {"pressure": 1.5e-6, "temperature": 3.3}}},
   "wind": {"self_weight": [0.1, 0, -0.2], "nodes": {"B1": {"z": -50.7, "rx": 0}}, "members": {"BC": [{"uniform": {"x": 0.1, "z": -8e-3}},
     {"trapezoid": {"z": [-1e-3, -4e-3]}, "from": 1000.3, "to": 3000, "frame": "local"}, {"point": {"y": 2.3, "rz": 1e2}, "at": 2500.7},
     {"temperature": {"uniform": 20.1, "gradient_z": 15e-3}}]}},
   "settle": {"settlements": {"B0": {"z": -10.3}}}, "nothing": {}},
 "combinations": {"service": {"dead": 1, "wind": 0.30000000000000004}, "other": {"settle": 1.35, "dead": 1}}})";

void check_same(const Building& a, const Building& b) {
  CHECK(a.title == b.title);
  CHECK(a.gravity == b.gravity);
  CHECK(a.units.length_name == b.units.length_name);
  REQUIRE(a.nodes.size() == b.nodes.size());
  for (std::size_t i = 0; i < a.nodes.size(); ++i) {
    CHECK(a.nodes[i].name == b.nodes[i].name);
    CHECK(a.nodes[i].position == b.nodes[i].position);
  }
  REQUIRE(a.materials.size() == b.materials.size());
  for (std::size_t i = 0; i < a.materials.size(); ++i) {
    CHECK(a.materials[i].youngs_modulus == b.materials[i].youngs_modulus);
    CHECK(a.materials[i].shear_modulus == b.materials[i].shear_modulus);
    CHECK(a.materials[i].density == b.materials[i].density);
    CHECK(a.materials[i].yield_strength == b.materials[i].yield_strength);
    CHECK(a.materials[i].thermal_expansion == b.materials[i].thermal_expansion);
  }
  REQUIRE(a.sections.size() == b.sections.size());
  for (std::size_t i = 0; i < a.sections.size(); ++i) {
    CHECK(a.sections[i].area == b.sections[i].area);
    CHECK(a.sections[i].Iy == b.sections[i].Iy);
    CHECK(a.sections[i].J == b.sections[i].J);
    CHECK(a.sections[i].shear_area_y == b.sections[i].shear_area_y);
    CHECK(a.sections[i].torsion_modulus == b.sections[i].torsion_modulus);
  }
  REQUIRE(a.members.size() == b.members.size());
  for (std::size_t i = 0; i < a.members.size(); ++i) {
    CHECK(a.members[i].name == b.members[i].name);
    CHECK(a.members[i].axes == b.members[i].axes);
    CHECK(a.members[i].kind == b.members[i].kind);
    CHECK(a.members[i].groups == b.members[i].groups);
    CHECK(a.members[i].offsets == b.members[i].offsets);
    const MemberDesign &p = a.members[i].design, &q = b.members[i].design;
    CHECK(p.checked == q.checked);
    CHECK(p.lengths == q.lengths);
    CHECK(p.factors == q.factors);
    CHECK(p.restrained_throughout == q.restrained_throughout);
    CHECK(p.restraints == q.restraints);
    CHECK(p.moment_factor == q.moment_factor);
    CHECK(p.equivalent_moment_y == q.equivalent_moment_y);
    CHECK(p.equivalent_moment_z == q.equivalent_moment_z);
    CHECK(p.stiffener_spacing == q.stiffener_spacing);
  }
  REQUIRE(a.panels.size() == b.panels.size());
  for (std::size_t i = 0; i < a.panels.size(); ++i) CHECK(a.panels[i].openings == b.panels[i].openings);
  REQUIRE(a.diaphragms.size() == b.diaphragms.size());
  for (std::size_t i = 0; i < a.diaphragms.size(); ++i) {
    CHECK(a.diaphragms[i].name == b.diaphragms[i].name);
    CHECK(a.diaphragms[i].nodes == b.diaphragms[i].nodes);
  }
  REQUIRE(a.masses.nodes.size() == b.masses.nodes.size());
  for (std::size_t i = 0; i < a.masses.nodes.size(); ++i) {
    CHECK(a.masses.nodes[i].node == b.masses.nodes[i].node);
    CHECK(a.masses.nodes[i].mass == b.masses.nodes[i].mass);
    CHECK(a.masses.nodes[i].inertia == b.masses.nodes[i].inertia);
  }
  CHECK(a.masses.members == b.masses.members);
  CHECK(a.masses.loads == b.masses.loads);
  REQUIRE(a.joints.size() == b.joints.size());
  for (std::size_t i = 0; i < a.joints.size(); ++i) {
    CHECK(a.joints[i].stiffness == b.joints[i].stiffness);
    CHECK(a.joints[i].capacity.value == b.joints[i].capacity.value);
    CHECK(a.joints[i].capacity.breakable == b.joints[i].capacity.breakable);
  }
  REQUIRE(a.supports.size() == b.supports.size());
  for (std::size_t i = 0; i < a.supports.size(); ++i) CHECK(a.supports[i].stiffness == b.supports[i].stiffness);
  REQUIRE(a.cases.size() == b.cases.size());
  for (std::size_t i = 0; i < a.cases.size(); ++i) {
    CHECK(a.cases[i].name == b.cases[i].name);
    CHECK(a.cases[i].self_weight == b.cases[i].self_weight);
    REQUIRE(a.cases[i].members.size() == b.cases[i].members.size());
    for (std::size_t k = 0; k < a.cases[i].members.size(); ++k) {
      const MemberLoad &p = a.cases[i].members[k], &q = b.cases[i].members[k];
      CHECK(p.member == q.member);
      CHECK(p.kind == q.kind);
      CHECK(p.frame == q.frame);
      CHECK(p.first == q.first);
      CHECK(p.last == q.last);
      CHECK(p.from == q.from);
      CHECK(p.to == q.to);
      CHECK(p.temperature == q.temperature);
      CHECK(p.gradient_y == q.gradient_y);
      CHECK(p.gradient_z == q.gradient_z);
    }
    REQUIRE(a.cases[i].nodes.size() == b.cases[i].nodes.size());
    for (std::size_t k = 0; k < a.cases[i].nodes.size(); ++k)
      CHECK(a.cases[i].nodes[k].load == b.cases[i].nodes[k].load);
    REQUIRE(a.cases[i].panels.size() == b.cases[i].panels.size());
    for (std::size_t k = 0; k < a.cases[i].panels.size(); ++k)
      CHECK(a.cases[i].panels[k].pressure == b.cases[i].panels[k].pressure);
    REQUIRE(a.cases[i].settlements.size() == b.cases[i].settlements.size());
    for (std::size_t k = 0; k < a.cases[i].settlements.size(); ++k)
      CHECK(a.cases[i].settlements[k].value == b.cases[i].settlements[k].value);
  }
  REQUIRE(a.combinations.size() == b.combinations.size());
  for (std::size_t i = 0; i < a.combinations.size(); ++i) {
    CHECK(a.combinations[i].name == b.combinations[i].name);
    CHECK(a.combinations[i].factors == b.combinations[i].factors);
  }
}

/// A .3dd file with every kind of load, radii, rolls, masses, condensation, and numbers without a short binary form.
const std::string full_3dd = R"(All that a file can hold
4  # nodes
1 0 0 0 0
2 0 0 3000.1 25.4
3 2000.7 0 3000.1 12.7
4 2000.7 700.3 3000.1 0.1
2
1 1 1 1 1 1 1
4 0 0 1 0 0 0
3
1 1 2 100.1 50.3 60.7 10 20 30 200000.1 80000.3 0 7.85e-9
3 3 4 100.1 50.3 60.7 10 20 30.9 200000.1 80000.3 33.3 7.85e-9
2 2 3 100.1 50.3 60.7 10 20 30 200000.1 80000.3 -71.7 7.9e-9
1 1  10.5 1.25 20
2
0.1 0.2 -9806.65
1
3 1.1 0 -1000.3 0 0 0.7
2
2 0.3 -5.1 0.7
2 0 0 1
1
2 0 0 0 0  500.3 1500.7 0.1 0.2  0.1 1900.3 0 -0.7
2
2 0 -5.3 0 1700.1
3 1 2 3 100.7
2
1 12.1e-6 100.7 200.3 10.1 20.2 30.3 70.7
2 0 1 1 1 2 3 4
1
1 0 0 -2.51 0 0.001 0
0 0 0
0 0 0 0 0 0
3
1 1
1e-9 0.1 12.5
1
3 0.1 1 2 3.3
1
2 0.7
2 1 2
0.5
2 1
3 1 0 0 1 0 0
1 3
)";

/// The numbers of a .3dd file as lines of text, sorted: loads on elements may change their order, which says nothing.
std::vector<std::string> sorted_lines(const std::string& text) {
  std::istringstream stream(frame3dd_text(parse_frame3dd_file(text, "a.3dd")));
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  std::sort(lines.begin(), lines.end());
  return lines;
}

}  // namespace

TEST_CASE("JSON to tables and back keeps every number to the bit") {
  const Scratch scratch;
  const fs::path in = scratch.write("in.json", full_model);
  const fs::path tables = scratch.convert(in, "tables");
  const fs::path back = scratch.convert(tables, "back.json");
  const Building original = read_model(in, Purpose::inspect);
  check_same(original, read_model(tables, Purpose::inspect));
  check_same(original, read_model(back, Purpose::inspect));
  // And the second time the tables are the same text.
  scratch.convert(back, "again");
  for (const auto& entry : fs::directory_iterator(tables))
    CHECK(formats::whole_text(entry.path()) ==
          formats::whole_text(scratch / ("again/" + entry.path().filename().string())));
}

TEST_CASE(".3dd to JSON and back keeps every number to the bit") {
  const Scratch scratch;
  const fs::path in = scratch.write("in.3dd", full_3dd);
  const fs::path json = scratch.convert(in, "model.json");
  const fs::path back = scratch.convert(json, "back.3dd");
  CHECK(sorted_lines(formats::whole_text(back)) == sorted_lines(full_3dd));
}

TEST_CASE("a .3dd file and its JSON are the same model") {
  const Scratch scratch;
  const fs::path in = scratch.write("in.3dd", full_3dd);
  const Building a = read_model(in, Purpose::inspect);
  const Building b = read_model(scratch.convert(in, "model.json"), Purpose::inspect);
  REQUIRE(a.members.size() == b.members.size());
  // Axes and lengths pass through other operations: rounding.
  for (std::size_t i = 0; i < a.members.size(); ++i) {
    CHECK((a.members[i].axes - b.members[i].axes).norm() < 1e-14);
    CHECK(a.members[i].length == Approx(b.members[i].length).epsilon(1e-14));
    CHECK(a[a.members[i].section].shear_area_y == b[b.members[i].section].shear_area_y);
    // Behind a radius there is less of the element, which bears the whole mass.
    const double whole = (a[a.members[i].nodes[1]].position - a[a.members[i].nodes[0]].position).norm();
    CHECK(a[a.members[i].material].density * a.members[i].length ==
          Approx(b[b.members[i].material].density * whole).epsilon(1e-14));
  }
  for (std::size_t k = 0; k < a.cases.size(); ++k)
    CHECK((a.gravity * a.cases[k].self_weight - b.gravity * b.cases[k].self_weight).norm() < 1e-11);
  CHECK(b.requested.cubic_p_delta);
  CHECK(b.requested.modes == 3);
  CHECK(b.requested.lumped_mass);
  CHECK(b.requested.frequency_shift == 0.1);
  CHECK(b.masses.nodes.at(0).inertia.z() == 3.3);
  REQUIRE(a.warnings.size() == 2);            // of the radii last
  CHECK(b.warnings.back() == a.warnings[0]);  // of the condensation
  // The temperatures of the faces: mean and gradients as the .3dd reader has them.
  const auto heat = [](const Building& building) {
    for (const MemberLoad& load : building.cases[0].members)
      if (load.kind == MemberLoad::Kind::temperature && load.temperature != 0) return load;
    return MemberLoad{};
  };
  CHECK(heat(a).temperature == Approx(heat(b).temperature).epsilon(1e-15));
  CHECK(heat(a).gradient_y == Approx(heat(b).gradient_y).epsilon(1e-15));
  CHECK(heat(a).gradient_z == Approx(heat(b).gradient_z).epsilon(1e-15));
}

TEST_CASE("the published .3dd examples go to JSON and back to the bit") {
  if (!topple::test::have_shared("reference/frame3dd/exE.3dd")) return;
  for (const char* name : {"exA", "exB", "exE", "exH"}) {
    const Scratch scratch;
    const fs::path in = topple::test::shared_path("reference/frame3dd/" + std::string(name) + ".3dd");
    const fs::path back = scratch.convert(scratch.convert(in, "model.json"), "back.3dd");
    INFO(name);
    CHECK(sorted_lines(formats::whole_text(back)) == sorted_lines(formats::whole_text(in)));
  }
}

TEST_CASE("what the target cannot hold is refused by its name") {
  const Scratch scratch;
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = full_model;
    text.replace(text.find(from), from.size(), to);
    return scratch.write("in.json", text);
  };
  CHECK_THAT(message(scratch, with(R"("supports":)", R"("analyses": {"modes": 3}, "supports":)"), "t"),
             Catch::Contains("analyses: tables cannot hold it"));
  CHECK_THAT(message(scratch, scratch.write("in.json", full_model), "out.3dd"),
             Catch::Contains(": a .3dd file cannot hold it"));
  const std::string frame = R"({"topple": 1, "materials": {"s": {"youngs_modulus": 2e11, "shear_modulus": 8e10}},
    "sections": {"b": {"area": 0.01, "Iy": 1e-4, "Iz": 1e-4, "J": 1e-4}}, "nodes": {"A": [0,0,0], "B": [3,0,0]},
    "joints": {"pin": {"stiffness": {"ry": 0}}},
    "members": {"AB": {"nodes": ["A", "B"], "section": "b", "material": "s"}}, "supports": {"A": "fixed"},
    "loads": {"u": {"members": {"AB": [{"uniform": {"z": -1}, "frame": "local"}]}}}})";
  const auto changed = [&](const std::string& from, const std::string& to) {
    std::string text = frame;
    text.replace(text.find(from), from.size(), to);
    return message(scratch, scratch.write("frame.json", text), "out.3dd");
  };
  CHECK(changed("-1", "-2") == "accepted");
  CHECK_THAT(changed(R"({"z": -1})", R"({"z": -1, "rx": 2})"),
             Catch::Contains("loads.u.members.AB[0].uniform.rx: a .3dd file cannot hold it"));
  CHECK_THAT(changed(R"("loads": {)", R"("combinations": {"c": {"u": 2}}, "loads": {"w": {"self_weight": 1}, )"),
             Catch::Contains("loads.w: a .3dd file cannot hold it"));
  CHECK_THAT(changed(R"("topple": 1)", R"("topple": 1, "units": {"length": "mm", "force": "N", "mass": "kg"})"),
             Catch::Contains("units: a .3dd file cannot hold it"));
  CHECK_THAT(changed(R"("material": "s")", R"("material": "s", "joints": ["pin", null])"),
             Catch::Contains("members.AB.joints[0]: a .3dd file cannot hold it"));
  CHECK_THAT(changed(R"("shear_modulus": 8e10)", R"("shear_modulus": 8e10, "poisson_ratio": 0.3)"),
             Catch::Contains("materials.s.poisson_ratio: a .3dd file cannot hold it"));
  CHECK_THAT(changed(R"("material": "s")", R"("material": "s", "offsets": [[0.1, 0, 0], [0, 0, 0]])"),
             Catch::Contains("members.AB.offsets: a .3dd file cannot hold it"));
  CHECK_THAT(changed(R"("A": "fixed")", R"("A": "fixed", "B": {"z": 1e6})"),
             Catch::Contains("supports.B: a .3dd file"));
  CHECK_THAT(message(scratch, scratch / "frame.json", "out.xyz"), Catch::Contains("the ending .xyz is not known"));
}

TEST_CASE("a frame written as .3dd keeps its axes and its answer") {
  const Scratch scratch;
  // Odd directions, `up` vectors and rolls; offsets along the members as radii of their nodes.
  const fs::path in = scratch.write("frame.json", R"({"topple": 1, "gravity": 10,
    "materials": {"s": {"youngs_modulus": 2e11, "shear_modulus": 8e10, "density": 7850}},
    "sections": {"b": {"area": 0.01, "Iy": 1e-4, "Iz": 3e-5, "J": 1e-5}},
    "nodes": {"A": [0,0,0], "B": [0,0,3], "C": [4,1,3.5], "D": [4,5,0]},
    "members": {"AB": {"kind": "post", "nodes": ["A", "B"], "section": "b", "material": "s", "up": [0, 1, 0]},
                "BC": {"nodes": ["B", "C"], "section": "b", "material": "s", "roll": 0.7853981633974483},
                "CD": {"nodes": ["C", "D"], "section": "b", "material": "s", "up": [1, 0, 0]}},
    "supports": {"A": "fixed", "D": "pinned"}, "loads": {"u": {"self_weight": 1, "nodes": {"C": {"x": 1000, "y": -300}}}}})");
  const Building a = read_model(in), b = read_model(scratch.convert(in, "frame.3dd"));
  for (std::size_t i = 0; i < a.members.size(); ++i) CHECK((a.members[i].axes - b.members[i].axes).norm() < 1e-11);
  const AnalysisResult ra = analyse(a), rb = analyse(b);
  for (std::size_t n = 0; n < a.nodes.size(); ++n)
    CHECK((ra.combinations[0].displacements[n] - rb.combinations[0].displacements[n]).norm() <
          1e-10 * ra.combinations[0].displacements[2].norm());
}

TEST_CASE("a generated building goes to tables with every part written out") {
  const Scratch scratch;
  const std::string text = R"({"topple": 1, "units": {"length": "mm", "force": "kN", "mass": "t"},
    "materials": {"s": {"youngs_modulus": 210, "poisson_ratio": 0.3, "density": 7.85e-9, "yield_strength": 0.355},
                  "c": {"youngs_modulus": 33, "poisson_ratio": 0.2, "density": 2.5e-9}},
    "sections": {"b": {"shape": "box", "depth": 300, "width": 200, "thickness": 12.5}, "w": {"catalogue": "W14x48"}},
    "joints": {"p": {"capacity": {"force": [9e3, 4e2, 3e2], "moment": [1e5, 6e5, 5e5]}, "strength": 1.5},
               "d": {"capacity": {"from": "section", "ratio": 0.8, "torsion": 5e4}, "interaction": "max"},
               "y": {"capacity": {"from": "section"}, "ductility": {"moment_y": 0.03}},
               "e": {"capacity_per_length": {"tension": 0.4, "shear_z": 0.2}}},
    "building": {"name": "A", "origin": [1000.1, 0, 0], "posts": [3, 2], "storeys": 2, "bay": [6000.3, [5000.7]],
      "storey_height": [4500, 3500.1],
      "post": [{"storeys": [1, 1], "section": "b", "material": "s", "joint": "p", "groups": ["lower"]},
               {"storeys": [2, 2], "section": "w", "material": "s", "joint": "y"}],
      "beam": {"section": "w", "material": "s", "joint": "d"},
      "slab": {"thickness": 200, "material": "c", "joint": "e", "span": "x", "pressure": {"dead": 1.5e-6, "live": 3e-6}},
      "wall": {"thickness": 150, "material": "c", "sides": ["x-", "x2"]},
      "omit": ["P-2-1-2", "S-1-1-2"], "base": {"x": true, "y": true, "z": 70.3}},
    "nodes": {"F": [0, 0, 9000]},
    "members": {"mast": {"nodes": ["A/N-1-1-2", "F"], "section": "b", "material": "s", "axial": "compression",
                         "offsets": [[0, 0, 100.3], [0, 0, -50]]}},
    "supports": {"F": {"x": true}},
    "loads": {"dead": {"self_weight": 1}, "live": {"members": {"A/BX-1-1-1": [{"uniform": {"z": -0.01}}]}}},
    "combinations": {"c": {"dead": 1.35, "live": 1.5}}})";
  const fs::path in = scratch.write("tower.json", text);
  const fs::path tables = scratch.convert(in, "tables");
  const Building a = read_model(in, Purpose::inspect), b = read_model(tables, Purpose::inspect);
  check_same(a, b);
  for (std::size_t i = 0; i < a.members.size(); ++i) CHECK(a.members[i].axial == b.members[i].axial);
  for (std::size_t i = 0; i < a.joints.size(); ++i) {
    CHECK(a.joints[i].capacity.interaction == b.joints[i].capacity.interaction);
    CHECK(a.joints[i].capacity.ductility == b.joints[i].capacity.ductility);
  }
  REQUIRE(a.panels.size() == b.panels.size());
  for (std::size_t i = 0; i < a.panels.size(); ++i) {
    CHECK(a.panels[i].name == b.panels[i].name);
    CHECK(a.panels[i].span == b.panels[i].span);
    CHECK(a.panels[i].model == b.panels[i].model);
    CHECK(a.panels[i].groups == b.panels[i].groups);
  }
  // A pressure of the rule and one of the case on the same panel add up.
  std::string more = text;
  const std::string dead = R"("dead": {"self_weight": 1})";
  more.replace(more.find(dead), dead.size(),
               R"("dead": {"self_weight": 1, "panels": {"A/S-2-1-2": {"pressure": 1e-6}}})");
  const Building added = read_model(scratch.convert(scratch.write("more.json", more), "more"), Purpose::inspect);
  double sum = 0;
  for (const PanelLoad& load : added.cases[0].panels)
    if (added[load.panel].name == "A/S-2-1-2") sum += load.pressure;
  CHECK(sum == Approx(2500).epsilon(1e-12));  // 1.5e-6 + 1e-6 kN/mm2
  // What comes back from the tables is the same again, to the last character.
  CHECK(convert_model(scratch.convert(tables, "again.json"), ModelForm::tables).files ==
        convert_model(tables, ModelForm::tables).files);
}

TEST_CASE(
    "a frame by shapes, a generator, loads in global axes and combinations becomes a .3dd file with the same answer") {
  const Scratch scratch;
  const fs::path in = scratch.write("frame.json", R"({"topple": 1, "units": {"length": "mm", "force": "N", "mass": "t"},
    "materials": {"s": {"youngs_modulus": 210e3, "poisson_ratio": 0.3, "density": 7.85e-9, "thermal_expansion": 1.2e-5}},
    "sections": {"b": {"shape": "box", "depth": 300, "width": 200, "thickness": 12.5}, "w": {"catalogue": "IPE300"}},
    "building": {"posts": [2, 2], "storeys": 2, "bay": [6000, 5000], "storey_height": 3500,
      "post": {"section": "b", "material": "s"}, "beam": {"section": "w", "material": "s"}},
    "nodes": {"F": [7000, 1000, 9000]},
    "members": {"mast": {"kind": "brace", "nodes": ["N-2-1-2", "F"], "section": "b", "material": "s", "roll": 0.7853981633974483}},
    "loads": {"dead": {"self_weight": 1},
      "live": {"nodes": {"F": {"x": 1e3, "rz": 2e5}}, "settlements": {"N-1-1-0": {"z": -3}},
               "members": {"mast": [{"uniform": {"x": 0.3, "y": 0.2, "z": -8}}, {"uniform": {"z": -2, "x": 1}, "frame": "projected"},
                                    {"trapezoid": {"z": [-1, -4], "y": [1, 0]}, "from": 100, "to": 1200},
                                    {"uniform": {"y": -1}, "from": 300},
                                    {"point": {"y": 2e3, "z": 1e3}, "at": 250},
                                    {"temperature": {"uniform": 20, "gradient_y": 0.01, "gradient_z": 0.015}}],
                           "BX-1-1-1": [{"uniform": {"z": -12}}]}}},
    "combinations": {"both": {"dead": 1.35, "live": 1.5}, "dead alone": {"dead": 1}}})");
  const fs::path out = scratch.convert(in, "frame.3dd");
  const Building a = read_model(in), b = read_model(out);
  CHECK_THAT(formats::whole_text(out), Catch::Contains("case 1 (both)") && Catch::Contains("# P-1-1-1 storey-1"));
  const AnalysisResult ra = analyse(a), rb = analyse(b);
  // Millimetres in one, no units in the other: displacements differ by the factor, rotations do not.
  const double tolerance = 1e-10;  // of the largest; the same frame but for the rounding of axes and areas
  for (std::size_t k = 0; k < 2; ++k) {
    double largest = 0;
    for (const Vec6& u : ra.combinations[k].displacements) largest = std::max(largest, u.head<3>().norm());
    CHECK(largest > 1e-4);
    for (std::size_t n = 0; n < a.nodes.size(); ++n) {
      const Vec6 &u = ra.combinations[k].displacements[n], &v = rb.combinations[k].displacements[n];
      CHECK((u.head<3>() - 1e-3 * v.head<3>()).norm() < tolerance * largest);
      CHECK((u.tail<3>() - v.tail<3>()).norm() < tolerance);
    }
  }
}
