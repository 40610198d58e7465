// Earthquake, winch, thermite, score and the camera's path.
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <glm/geometric.hpp>

#include "app/controller.h"
#include "app/tools/score.h"
#include "standing_still.h"
#include "support/scratch_folder.h"
#include "topple/structure/error.h"
#include "topple/structure/formats/input_files.h"

namespace {

using namespace topple::viewer;
using topple::structure::MemberId;
using topple::structure::NodeId;
using topple::structure::Vec3;

struct Run {
  Scene scene = standing_still(open_scene("seed_building"));
  Session session{scene.building, scene.scenario};
  DirectDriver driver{session};
  Controller controller{driver, scene, 0, glm::dvec2(800, 600)};
  void go(int steps) {
    for (int i = 0; i < steps; ++i) driver.advance();
  }
  /// N, of all supports.
  [[nodiscard]] Vec3 reaction() const {
    Vec3 sum = Vec3::Zero();
    for (std::size_t s = 0; s < scene.building->supports.size(); ++s)
      sum += session.simulation().frame().reaction(s).head<3>();
    return sum;
  }
  [[nodiscard]] MemberId member(const char* name) const { return *controller.names().member(name); }
};

/// kg, as a person would add it up.
double mass_of(const topple::structure::Building& building) {
  double sum = 0;
  for (const auto& m : building.members) sum += building[m.material].density * building[m.section].area * m.length;
  for (const auto& p : building.panels) {
    const Vec3 a = building[p.nodes[1]].position - building[p.nodes[0]].position;
    const Vec3 b = building[p.nodes[3]].position - building[p.nodes[0]].position;
    sum += building[p.material].density * p.thickness * a.cross(b).norm();
  }
  return sum;
}

Earthquake steady(double ax, double az = 0) {
  topple::structure::TimeHistory ground;
  ground.times = {0, 1};
  ground.series = {{0, {}, {ax, ax}}, {2, {}, {az, az}}};
  return {std::make_shared<const topple::structure::TimeHistory>(ground)};
}

}  // namespace

TEST_CASE("a ground that is accelerated needs the force of mass times acceleration, and none when it is over") {
  Run run;
  run.go(2);
  const Vec3 before = run.reaction();
  run.session.shake(steady(0.2));
  run.go(3);
  // What has weight has mass, loads on the floors too.
  const double mass = before.z() / run.scene.building->gravity;
  CHECK(mass > mass_of(*run.scene.building));
  CHECK((run.reaction().x() - before.x()) / 0.2 == Approx(mass).epsilon(1e-6));
  CHECK(run.reaction().z() == Approx(before.z()).epsilon(1e-9));
  run.go(70);
  CHECK((run.reaction() - before).norm() < 1e-6 * before.norm());
  // Upwards it is as if all were heavier.
  run.session.shake(steady(0, 0.5));
  run.go(3);
  CHECK((run.reaction().z() - before.z()) / 0.5 == Approx(mass).epsilon(1e-6));
}

TEST_CASE("an earthquake is undone, and saved with the run, and one line among the events tells of it") {
  Run run;
  run.go(5);
  const auto before = run.session.simulation().hash();
  run.session.shake(steady(0.2));  // what it bears
  run.go(20);
  REQUIRE(run.session.simulation().bodies().empty());
  const auto then = run.session.simulation().hash();
  const std::string saved = run.session.save();
  int told = 0;
  for (const auto& event : run.session.recording()->events())
    told += event.kind == topple::structure::SimulationEvent::Kind::tool ? 1 : 0;
  CHECK(told == 1);
  REQUIRE(run.session.undo());
  CHECK(run.session.simulation().hash() == before);
  run.session.load(topple::structure::parse_snapshot(saved, "saved"));
  CHECK(run.session.simulation().hash() == then);
  // It ends there: nothing pushes sideways any more.
  run.go(3);
  CHECK(std::abs(run.reaction().x()) < 1e-6 * run.reaction().z());
  run.session.return_to(5);
  CHECK(run.session.simulation().hash() == before);
}

TEST_CASE("a computed motion reaches its peak, swings as firm soil does, and is the same again") {
  const auto ground = strong_motion(4, 20);
  double peak = 0;
  int crossings = 0;
  for (const auto& one : ground.series)
    for (std::size_t i = 0; i < one.values.size(); ++i) {
      peak = std::max(peak, std::abs(one.values[i]));
      if (i > 0 && (one.values[i] > 0) != (one.values[i - 1] > 0)) ++crossings;
    }
  CHECK(peak == Approx(4));
  REQUIRE(ground.series.size() == 2);
  // Twice a mean frequency for 2 x 20 s. The spectrum's own, from its moments up to 15 Hz, is 4 to 5 Hz.
  CHECK(crossings / 80.0 > 3);
  CHECK(crossings / 80.0 < 6);
  CHECK(strong_motion(4, 20).series[1].values == ground.series[1].values);
  CHECK(strong_motion(4, 20, 2).series[1].values != ground.series[1].values);
  CHECK(ground_acceleration(ground, -0.1).isZero(0));
  CHECK(ground_acceleration(ground, 20.1).isZero(0));
  CHECK(ground_acceleration(ground, 0.005).x() ==
        Approx((ground.series[0].values[0] + ground.series[0].values[1]) / 2));
}

TEST_CASE("an earthquake is read from a file, and one that is none is refused") {
  Run run;
  const topple::test::ScratchFolder folder;
  run.controller.hand.shaking.file = (folder / "ground.csv").string();
  std::ofstream(run.controller.hand.shaking.file) << "time,ax\n0,0.3\n2,0.3\n";
  run.controller.shake();
  run.go(3);
  CHECK(run.reaction().x() / 0.3 == Approx(run.reaction().z() / run.scene.building->gravity).epsilon(1e-6));
  std::ofstream(run.controller.hand.shaking.file) << "time,dead\n0,1\n2,1\n";
  CHECK_THROWS_AS(run.controller.shake(), topple::structure::InputError);
}

TEST_CASE("a winch pulls with a force that grows to what is asked, along its rope, and lets go of what falls") {
  Run run;
  run.go(2);
  const Vec3 before = run.reaction();
  const NodeId node = (*run.scene.building)[run.member("P-1-1-3")].nodes[1];
  const Vec3 at = (*run.scene.building)[node].position, winch = at + Vec3(-12, 0, -at.z());
  run.session.pull({node, winch, 20e3, 1.0});
  run.go(32);
  const double half = (run.reaction() - before).norm();
  CHECK(half == Approx(10e3).margin(2e3 + 1));  // an increment of a tenth
  run.go(40);
  const Vec3 pull = -(run.reaction() - before);
  CHECK((pull - 20e3 * (winch - at).normalized()).norm() < 1e-3 * 20e3);
  REQUIRE(run.driver.moment().later->ropes.size() == 1);
  CHECK((run.driver.moment().later->ropes[0][0] - at).norm() < 0.01);
  // What it pulled at is gone, and so is the rope.
  run.session.apply(topple::structure::RemoveTool{{run.member("P-1-1-3"), run.member("P-1-1-4")}, {}, {}});
  run.go(120);
  if (!run.session.simulation().frame().stands(node)) CHECK(run.driver.moment().later->ropes.empty());
}

TEST_CASE("thermite cuts a joint when its time is over, and throws sparks until then") {
  Run run;
  run.go(1);
  const auto joint = *run.controller.names().joint("BX-1-1-6:1");
  run.session.burn_through({joint, 1.0});
  run.go(40);
  CHECK(run.session.simulation().frame().intact(joint));
  REQUIRE(run.driver.moment().later->dust);
  for (const DustPuff& puff : *run.driver.moment().later->dust) CHECK(puff.kind == DustPuff::Kind::sparks);
  run.go(25);
  CHECK_FALSE(run.session.simulation().frame().intact(joint));
}

TEST_CASE("the score weighs what is down, where it lies, and how many actions it took") {
  Run run;
  const auto& building = *run.scene.building;
  CHECK(score_of(building, *run.driver.moment().later, 0).points() == 0);
  const auto& post = building[run.member("P-1-1-6")];
  const double mass = building[post.material].density * building[post.section].area * post.length;
  run.session.apply(topple::structure::RemoveTool{{run.member("P-1-1-6")}, {}, {}});
  // Within the first step nothing else has come off.
  Snapshot moment = *run.driver.moment().later;
  auto where = std::make_shared<Membership>(*moment.membership);
  where->member[static_cast<std::size_t>(run.member("P-1-1-6").index)] = part_gone;
  moment.membership = where;
  const Score one = score_of(building, moment, 1);
  CHECK(one.down == Approx(mass / mass_of(building)).epsilon(1e-9));
  run.go(1);
  CHECK(run.driver.moment().later->actions == 1);
  // A post that lies 100 m away is not on its own ground.
  moment.bodies.push_back({});
  moment.bodies.back().rest_centre = (building[post.nodes[0]].position + building[post.nodes[1]].position) / 2;
  moment.bodies.back().position = {100, 0, 0};
  where->member[static_cast<std::size_t>(run.member("P-1-1-6").index)] = 0;
  CHECK(score_of(building, moment, 1).inside == 0);
  moment.bodies.back().position = {1, 1, 0.2};
  CHECK(score_of(building, moment, 1).inside == 1);
  Score all{1, 0.9, 3};
  CHECK(all.points() == 72);  // 90 less two tenths
  all.actions = 40;
  CHECK(all.points() == 0);
}

TEST_CASE("the eye goes smoothly through its places and stops at the last") {
  std::vector<Camera> views(3);
  views[0].eye = {0, 0, 5}, views[1].eye = {10, 0, 5}, views[2].eye = {10, 10, 8};
  CHECK(glm::length(along_path(views, 0).eye - views[0].eye) < 1e-12);
  CHECK(glm::length(along_path(views, 1).eye - views[1].eye) < 1e-12);
  CHECK(glm::length(along_path(views, 9).eye - views[2].eye) < 1e-12);
  double longest = 0;
  for (double t = 0; t < 2; t += 0.01)
    longest = std::max(longest, glm::length(along_path(views, t + 0.01).eye - along_path(views, t).eye));
  CHECK(longest < 0.01 * 2 * 10.5);  // no leap: at most twice the even pace
  Run run;
  run.controller.key("f5");
  run.controller.key("8");
  run.controller.key("f5");
  const Camera last = run.controller.camera;
  run.controller.key("f6");
  run.controller.update(1.5);
  CHECK(glm::length(run.controller.camera.eye - last.eye) > 1);
  run.controller.update(2);
  CHECK(glm::length(run.controller.camera.eye - last.eye) < 1e-9);
  CHECK_FALSE(run.controller.path().flying());
}

TEST_CASE("everything is reached by keys: the eye, the tools, the pace") {
  Run run;
  const Camera before = run.controller.camera;
  for (const char* key : {"left", "up"}) CHECK(run.controller.key(key));
  CHECK(glm::length(run.controller.camera.eye - before.eye) > 0.1);
  CHECK(run.controller.key("minus"));
  CHECK(run.driver.speed() == Approx(0.5));
  CHECK(run.controller.key("equal"));
  CHECK(run.driver.speed() == Approx(1));
  // Enter uses the tool on what is in the middle.
  run.controller.camera.target = {0, 0, 2};
  run.controller.camera.eye = {-8, -8, 3};
  run.controller.key("j");
  run.controller.key("enter");
  run.go(1);
  REQUIRE(run.controller.message);
  CHECK(run.controller.message->rfind("cut ", 0) == 0);
}
