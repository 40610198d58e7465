// The model reader takes in every key of the format with its meaning and its default.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>

#include "example_model.h"
#include "topple/structure/error.h"
#include "topple/structure/formats/files.h"

using namespace topple::structure;
using topple::test::example_model;
using topple::test::replaced;

namespace {

Building read(const std::string& text) { return parse_model(text, "m.json", Purpose::inspect); }

const Joint& joint(const Building& building, const std::string& name) {
  for (const Joint& candidate : building.joints)
    if (candidate.name == name) return candidate;
  throw std::logic_error("no joint " + name);
}
const Member& member(const Building& building, const std::string& name) {
  return building[NameIndex(building).member(name).value()];
}
double capacity(const Building& building, const std::string& name, Sense sense) {
  return joint(building, name).capacity.value[static_cast<std::size_t>(sense)];
}

}  // namespace

TEST_CASE("the format's example is read in full") {
  const Building building = read(example_model);
  CHECK(building.title == "Two bays");
  CHECK(building.file == "m.json");
  CHECK(building.nodes.size() == 8);
  CHECK(building.members.size() == 9);
  CHECK(building.panels.size() == 2);
  CHECK(building.joints.size() == 2 * 9 + 4 * 2);
  CHECK(building.supports.size() == 4);
  REQUIRE(building.edge_supports.size() == 1);
  CHECK(building.edge_supports[0].edge == 0);
  CHECK(building.edge_supports[0].stiffness[0] == unlimited);
  CHECK(building.edge_supports[0].stiffness[3] == 0);
  CHECK(building.diaphragms.at(0).nodes.size() == 4);
  CHECK(building.masses.nodes.at(0).mass == 1200);
  CHECK(building.masses.loads.at(0).second == 0.2);
  CHECK(building.combinations.at(1).name == "collapse");
  CHECK(building.combinations.at(1).factors.at(0).second == 1.2);
  CHECK(building.warnings.empty());
  CHECK(building[building.panels[1].nodes[2]].name == "B1");
  CHECK(building.panels[1].mesh == std::array<int, 2>{4, 3});
  CHECK(building.panels[1].openings.at(0).size() == 4);
  const NodeSupport& spring = building.supports[2];
  CHECK(spring.stiffness[2] == 5e7);
  CHECK(spring.stiffness[0] == unlimited);
  CHECK(spring.stiffness[4] == 0);
}

TEST_CASE("a material's missing elastic constant follows from G = E/(2 (1 + nu))") {
  const Building building = read(example_model);
  CHECK(building.materials[0].shear_modulus == Approx(210e9 / 2.6).epsilon(1e-15));
  CHECK(building.materials[1].poisson_ratio == Approx(0.2).epsilon(1e-14));
}

TEST_CASE("member axes follow up, roll and offsets") {
  const Building building = read(example_model);
  const Member& post = member(building, "PB");  // vertical: default up is global x
  CHECK((post.axes.row(0).transpose() - Vec3::UnitZ()).norm() == 0);
  CHECK((post.axes.row(2).transpose() - Vec3::UnitX()).norm() == 0);
  CHECK((post.axes.row(1).transpose() - Vec3::UnitX().cross(Vec3::UnitZ())).norm() == 0);
  const Member& beam = member(building, "AB");  // horizontal: z points up
  CHECK((beam.axes.row(2).transpose() - Vec3::UnitZ()).norm() == 0);
  CHECK(beam.length == Approx(5.7).epsilon(1e-15));
  const Building rolled = read(replaced(example_model, "\"roll\": 0", "\"roll\": 0.5235987755982988"));  // 30 degrees
  const Mat3& before = member(building, "PA").axes;
  const Mat3& after = member(rolled, "PA").axes;
  CHECK(after.row(1).dot(before.row(1)) == Approx(std::sqrt(0.75)));
  CHECK(after.row(1).dot(before.row(2)) == Approx(0.5));
  CHECK(after.row(2).dot(before.row(1)) == Approx(-0.5));
  CHECK((after * after.transpose() - Mat3::Identity()).norm() < 1e-15);
}

TEST_CASE("panel axes run from node 1 to 2 with the normal by the right-hand rule") {
  const Building building = read(example_model);
  CHECK((building.panels[0].axes - Mat3::Identity()).norm() < 1e-15);
  const Mat3& wall = building.panels[1].axes;
  CHECK((wall.row(0).transpose() - Vec3::UnitX()).norm() < 1e-15);
  CHECK((wall.row(2).transpose() + Vec3::UnitY()).norm() < 1e-15);
}

TEST_CASE("joint capacities come as numbers, from the section, or as the original's thresholds") {
  const Building building = read(example_model);
  CHECK(capacity(building, "PA:1", Sense::compression) == 8e6);
  CHECK_FALSE(joint(building, "PA:2").capacity.breakable);
  CHECK(capacity(building, "PC:1", Sense::tension) == 1.5 * 9e6);
  CHECK(capacity(building, "PC:1", Sense::compression) == 1.5 * 9e6);
  CHECK(capacity(building, "PC:1", Sense::torsion) == 1.5 * 1e5);
  CHECK(joint(building, "PC:1").capacity.interaction == Interaction::max);
  // W14x48: A = 14.1 in2, Zx = 78.4 in3 (AISC manual); six digits of the table.
  CHECK(capacity(building, "BC:1", Sense::tension) == Approx(0.8 * 14.1 * 0.0254 * 0.0254 * 355e6).epsilon(1e-5));
  CHECK(capacity(building, "BC:1", Sense::moment_y) == Approx(0.8 * 78.4 * std::pow(0.0254, 3) * 355e6).epsilon(1e-5));
  CHECK(capacity(building, "BC:1", Sense::torsion) == 5e4);
  CHECK(joint(building, "BC:1").capacity.interaction == Interaction::sum);
  CHECK(joint(building, "CD:1").capacity.interaction == Interaction::max);
  CHECK(joint(building, "CD:1").capacity.ductility[5] == 0.03);
  CHECK(capacity(building, "DA:1", Sense::shear_z) == Approx(0.8 * 0.006 * 355e6 / std::sqrt(3.0)));
  CHECK(joint(building, "AB:2").stiffness[4] == 0);
  CHECK(joint(building, "AB:2").stiffness[3] == unlimited);
  CHECK(joint(building, "CD:2").stiffness[4] == 4e7);
  CHECK(capacity(building, "S1:4", Sense::shear_z) == 2e5);
  CHECK(capacity(building, "S1:4", Sense::moment_y) == unlimited);
}

TEST_CASE("loads keep their kinds, frames and places") {
  const Building building = read(example_model);
  const LoadCase& live = building.cases[1];
  REQUIRE(live.members.size() == 4);
  CHECK(live.members[0].to == 6);
  CHECK(live.members[0].last[2] == -8e3);
  CHECK(live.members[1].from == 1);
  CHECK(live.members[1].last[2] == -4e3);
  CHECK(live.members[2].kind == MemberLoad::Kind::point);
  CHECK(live.members[2].frame == LoadFrame::local);
  CHECK(live.members[2].from == 2.5);
  CHECK(live.members[3].gradient_z == 15);
  CHECK(live.nodes.at(0).load[2] == -5e4);
  CHECK(building.cases[0].self_weight == Vec3(0, 0, -1));
  CHECK(building.cases[2].settlements.at(0).value == -0.01);
}

TEST_CASE("without loads there is one combination, the self weight") {
  const Building building = read(R"({"topple": 1, "materials": {"m": {"youngs_modulus": 1, "poisson_ratio": 0}},
    "sections": {"s": {"shape": "circle", "diameter": 1}}, "nodes": {"a": [0,0,0], "b": [1,0,0]},
    "members": {"ab": {"nodes": ["a", "b"], "section": "s", "material": "m"}}})");
  REQUIRE(building.combinations.size() == 1);
  CHECK(building.combinations[0].name == "self weight");
  CHECK(building.cases[0].self_weight == Vec3(0, 0, -1));
  CHECK(building.members[0].kind == MemberKind::beam);
  CHECK(building.gravity == 9.80665);
}

TEST_CASE("each case is a combination where none are given, and one without self weight is told") {
  const std::string combinations = R"(,
  "combinations": {"service": {"dead": 1, "live": 1}, "collapse": {"dead": 1.2, "live": 0.5}})";
  const Building building = read(replaced(example_model, combinations, ""));
  REQUIRE(building.combinations.size() == 3);
  CHECK(building.combinations[2].name == "settle");
  REQUIRE(building.warnings.size() == 1);
  CHECK(building.warnings[0] == "combinations \"live\", \"settle\" have no self weight");
}

TEST_CASE("a model in other units is the same building") {
  // One beam in mm, kN, t and in in, kip, lb, each number converted by hand from the SI text with exact unit
  // definitions.
  const auto model = [](const std::string& units, double L, double F, double M) {
    const auto number = [](double v) {
      char text[40];
      std::snprintf(text, sizeof text, "%.17g", v);
      return std::string(text);
    };
    return R"({"topple": 1, "units": )" + units + R"(, "gravity": )" + number(9.8 / L) +
           R"(, "materials": {"m": {"youngs_modulus": )" + number(2e11 / (F / L / L)) +
           R"(, "poisson_ratio": 0.3, "density": )" + number(7850 / (M / L / L / L)) + R"(, "yield_strength": )" +
           number(3e8 / (F / L / L)) +
           R"(, "thermal_expansion": 1e-5}}, "sections": {"s": {"shape": "rectangle", "depth": )" + number(0.4 / L) +
           R"(, "width": )" + number(0.2 / L) + R"(}, "n": {"area": )" + number(0.01 / L / L) + R"(, "Iy": )" +
           number(1e-4 / L / L / L / L) + R"(, "Iz": 1, "J": 1, "torsion_modulus": )" + number(2e-5 / L / L / L) +
           R"(}}, "joints": {"j": {"stiffness": {"x": )" + number(5e7 / (F / L)) + R"(, "ry": )" +
           number(4e7 / (F * L)) + R"(}, "capacity": {"from": "section", "moment_z": )" + number(1e5 / (F * L)) +
           R"(}}, "e": {"capacity_per_length": {"shear_z": )" + number(2e5 / (F / L)) +
           R"(}}}, "nodes": {"a": [0,0,0], "b": [)" + number(6 / L) + R"(,0,0], "c": [)" + number(6 / L) + "," +
           number(6 / L) + R"(,0], "d": [0,)" + number(6 / L) +
           R"(,0]}, "members": {"ab": {"nodes": ["a", "b"], "section": "s", "material": "m", "joints": ["j", null]}},
              "panels": {"p": {"nodes": ["a", "b", "c", "d"], "thickness": )" +
           number(0.2 / L) + R"(, "material": "m", "joint": "e"}}, "supports": {"a": {"z": )" + number(3e7 / (F / L)) +
           R"(, "rx": )" + number(3e7 / (F * L)) + R"(}}, "masses": {"nodes": {"b": [)" + number(100 / M) + "," +
           number(50 / (M * L * L)) + R"(,0,0]}}, "loads": {"l": {"panels": {"p": {"pressure": )" +
           number(1500 / (F / L / L)) + R"(}}, "nodes": {"b": {"y": )" + number(1e4 / F) + R"(, "rz": )" +
           number(2e4 / (F * L)) + R"(}}, "settlements": {"a": {"z": )" + number(0.01 / L) +
           R"(, "rx": 0.001}}, "members": {"ab": [{"uniform": {"z": )" + number(-8e3 / (F / L)) + R"(, "rx": )" +
           number(30 / F) + R"(}}, {"point": {"z": 0}, "at": )" + number(2.5 / L) +
           R"(}, {"temperature": {"uniform": 20, "gradient_z": )" + number(15 * L) + R"(}}]}}}})";
  };
  const Building si = read(model(R"({})", 1, 1, 1));
  struct {
    const char* units;
    double L, F, M;
  } const systems[] = {{R"({"length": "mm", "force": "kN", "mass": "t"})", 1e-3, 1e3, 1e3},
                       {R"({"length": "in", "force": "kip", "mass": "lb"})", 0.0254, 4448.2216152605, 0.45359237},
                       {R"({"length": "ft", "force": "lbf"})", 0.3048, 4.4482216152605, 1},
                       {R"({"length": "cm", "force": "MN", "mass": "kg"})", 1e-2, 1e6, 1}};
  // A handful of roundings in each number.
  const auto same = [](double value) { return Approx(value).epsilon(1e-13); };
  for (const auto& system : systems) {
    CAPTURE(system.units);
    const Building other = read(model(system.units, system.L, system.F, system.M));
    CHECK(other.gravity == same(9.8));
    CHECK(other.materials[0].youngs_modulus == same(2e11));
    CHECK(other.materials[0].density == same(7850));
    CHECK(*other.materials[0].yield_strength == same(3e8));
    CHECK(other.sections[0].Iy == same(0.2 * 0.064 / 12));
    CHECK(other.sections[1].area == same(0.01));
    CHECK(other.sections[1].Iy == same(1e-4));
    CHECK(*other.sections[1].torsion_modulus == same(2e-5));
    CHECK(other.joints[0].stiffness[0] == same(5e7));
    CHECK(other.joints[0].stiffness[4] == same(4e7));
    for (std::size_t s = 0; s < 7; ++s)
      CHECK(other.joints[0].capacity.value[s] == same(si.joints[0].capacity.value[s]));
    CHECK(other.joints[0].capacity.value[6] == same(1e5));
    CHECK(other.joints[2].capacity.value[3] == same(2e5));
    CHECK(other.members[0].length == same(6));
    CHECK(other.panels[0].thickness == same(0.2));
    CHECK(other.supports[0].stiffness[2] == same(3e7));
    CHECK(other.supports[0].stiffness[3] == same(3e7));
    CHECK(other.masses.nodes[0].mass == same(100));
    CHECK(other.masses.nodes[0].inertia[0] == same(50));
    const LoadCase& loads = other.cases[0];
    CHECK(loads.panels[0].pressure == same(1500));
    CHECK(loads.nodes[0].load[1] == same(1e4));
    CHECK(loads.nodes[0].load[5] == same(2e4));
    CHECK(loads.settlements[0].value == same(0.01));
    CHECK(loads.settlements[1].value == 0.001);
    CHECK(loads.members[0].first[2] == same(-8e3));
    CHECK(loads.members[0].first[3] == same(30));
    CHECK(loads.members[1].from == same(2.5));
    CHECK(loads.members[2].temperature == 20);
    CHECK(loads.members[2].gradient_z == same(15));
  }
}

TEST_CASE("consistent units convert nothing") {
  const Building building =
      read(replaced(replaced(example_model, R"({"length": "m", "force": "N", "mass": "kg"})", "\"consistent\""),
                    R"({"catalogue": "W14x48"})", R"({"shape": "rectangle", "depth": 2, "width": 1})"));
  CHECK(building.units.consistent);
  CHECK(building.units.length == 1);
  CHECK(building.units.length_name == "consistent");
}
