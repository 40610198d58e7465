// Capacities that are changed over a model, and the model's file that says so.
#include <catch2/catch.hpp>
#include <fstream>

#include "support/scratch_folder.h"
#include "topple/structure/error.h"
#include "topple/structure/formats/files.h"
#include "topple/structure/joint_tuning.h"

namespace {

using namespace topple::structure;

JointChange change(const std::string& joints, std::optional<double> strength,
                   std::optional<std::pair<Sense, double>> capacity = {}) {
  JointChange one;
  one.joints = joints;
  one.strength = strength;
  if (capacity) one.capacity[static_cast<std::size_t>(capacity->first)] = capacity->second;
  return one;
}

Building seed() { return read_model(find_model("seed_building")); }
JointId joint(const Building& building, const std::string& name) { return *NameIndex(building).joint(name); }
double capacity(const JointTuning& tuning, JointId id, Sense sense) {
  return tuning.capacity(id).value[static_cast<std::size_t>(sense)];
}

}  // namespace

TEST_CASE("a change means a group, a name, a pattern or every joint, and later ones win") {
  const Building building = seed();
  JointTuning tuning(building);
  const JointId beam = joint(building, "BX-1-1-1:1"), post = joint(building, "P-1-1-1:1");
  CHECK(tuning.apply(change("*", 2.0)).size() == building.joints.size());
  CHECK(capacity(tuning, beam, Sense::moment_y) == 2 * 2.4e5);  // what models/seed_building.json says, doubled
  (void)tuning.apply(change("beams", {}, {{Sense::moment_y, 5e5}}));
  CHECK(capacity(tuning, beam, Sense::moment_y) == 1e6);
  CHECK(capacity(tuning, post, Sense::moment_y) == 4e5);
  CHECK(tuning.apply(change("BX-1-1-1:1", 1.0)).size() == 1);
  CHECK(capacity(tuning, beam, Sense::moment_y) == 5e5);
  CHECK(tuning.apply(change("P-1-1-*", 3.0)).size() == 12);
  CHECK(capacity(tuning, post, Sense::moment_y) == 6e5);
  // A post's top belongs to its node: it is rigid and never breaks, whatever its strength.
  CHECK_FALSE(tuning.capacity(joint(building, "P-1-1-1:2")).breakable);
  tuning.reset();
  CHECK(capacity(tuning, beam, Sense::moment_y) == 2.4e5);
}

TEST_CASE("a joint that never broke can be given a capacity") {
  const Building building = seed();
  JointTuning tuning(building);
  const JointId top = joint(building, "P-1-1-1:2");
  (void)tuning.apply(change("P-1-1-1:2", {}, {{Sense::compression, 1e6}}));
  CHECK(tuning.capacity(top).breakable);
  CHECK(capacity(tuning, top, Sense::compression) == 1e6);
  CHECK(capacity(tuning, top, Sense::moment_y) == unlimited);
}

TEST_CASE("a drag of a slider leaves one change, in its last place") {
  const Building building = seed();
  JointTuning tuning(building);
  for (const double strength : {1.1, 1.2, 1.3}) (void)tuning.apply(change("beams", strength));
  (void)tuning.apply(change("posts", 0.5));
  (void)tuning.apply(change("beams", 0.9));
  REQUIRE(tuning.changes().size() == 2);
  CHECK(tuning.changes()[0].joints == "posts");
  CHECK(tuning.changes()[1].strength == 0.9);
}

TEST_CASE("wrong changes are refused by name") {
  const Building building = seed();
  JointTuning tuning(building);
  CHECK_THROWS_WITH(tuning.apply(change("columns", 2.0)), Catch::Contains("'columns'") && Catch::Contains("posts"));
  CHECK_THROWS_WITH(tuning.apply(change("beams", -1.0)), Catch::Contains("strength"));
  CHECK_THROWS_AS(tuning.apply(change("beams", {}, {{Sense::torsion, 0.0}})), InputError);
}

TEST_CASE("a model written with its changes reads back as it was tuned, and so does a copy of the copy") {
  const topple::test::ScratchFolder folder;
  const Building building = seed();
  JointTuning tuning(building);
  (void)tuning.apply(change("beams", 1.25));
  (void)tuning.apply(change("BX-2-2-3:2", {}, {{Sense::shear_z, 123456.789}}));
  const auto first = folder / "first.json", second = folder / "second.json";
  std::ofstream(first) << model_with_changes(find_model("seed_building"), tuning.changes());
  const Building again = read_model(first);
  for (std::size_t j = 0; j < building.joints.size(); ++j)
    REQUIRE(again.joints[j].capacity.value == tuning.capacity(JointId(j)).value);
  JointTuning more(again);
  (void)more.apply(change("posts", 2.0));
  std::ofstream(second) << model_with_changes(first, more.changes());
  const Building twice = read_model(second);
  CHECK(capacity(JointTuning(twice), joint(twice, "P-1-1-1:1"), Sense::moment_y) == 4e5);
  CHECK(capacity(JointTuning(twice), joint(twice, "BX-1-1-1:1"), Sense::moment_y) == Approx(3e5).epsilon(1e-15));
}

TEST_CASE("joint_changes in a model are read in its units and refused where they are wrong") {
  const std::string model = R"({"topple": 1, "units": {"length": "mm", "force": "kN"},
    "materials": {"m": {"youngs_modulus": 210, "poisson_ratio": 0.3}},
    "sections": {"s": {"shape": "box", "depth": 200, "width": 200, "thickness": 10}},
    "joints": {"j": {"capacity": {"moment_y": 1000}}},
    "nodes": {"A": [0, 0, 0], "B": [3000, 0, 0]},
    "members": {"AB": {"nodes": ["A", "B"], "section": "s", "material": "m", "joints": ["j", null]}},
    "supports": {"A": "fixed"}, "joint_changes": )";
  const Building building = parse_model(model + R"([{"joints": "AB:1", "moment_y": 5000}]})", "m.json");
  CHECK(building.joints[0].capacity.value[5] == Approx(5000.0));  // 5000 kN mm
  const auto refused = [&](const std::string& changes) {
    try {
      (void)parse_model(model + changes + "}", "m.json");
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  CHECK(refused(R"([{"joints": "XY:1", "strength": 2}])").find("joint_changes[0]") != std::string::npos);
  CHECK(refused(R"([{"joints": "AB:1"}])").find("strength") != std::string::npos);
  CHECK(refused(R"([{"joints": "AB:1", "strength": 0}])").find("joint_changes[0].strength") != std::string::npos);
  CHECK(refused(R"([{"joints": "AB:1", "weight": 1}])").find("weight") != std::string::npos);
}
