// What stands and moves is seen: by a scale of its own, its joints and its energies over time.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "app/open_scene.h"
#include "app/panels/energy_panel.h"
#include "app/session.h"
#include "app/show_words.h"
#include "renderer/instances/scene_instances.h"

using namespace topple::viewer;
using topple::structure::Ledger;

namespace {

/// A building that is pushed sideways at once, by a thirtieth of its weight: it swings, and nothing breaks.
struct Pushed {
  Scene scene = moving_scene();
  Session session{scene.building, scene.scenario};
  std::shared_ptr<const Snapshot> start;
  Pushed() {
    session.step();
    start = session.snapshot();
    session.apply(topple::structure::GravityTool{{9.81 / 30, 0, -9.81}});
  }
  std::shared_ptr<const Snapshot> go(int steps) {
    std::shared_ptr<const Snapshot> now;
    for (int i = 0; i < steps; ++i) session.step(), now = session.snapshot();
    return now;
  }
  static Scene moving_scene() {
    Scene scene = open_scene("seed_building");
    scene.scenario.standing = topple::structure::StandingRule::dynamics;
    return scene;
  }
};

/// Of the first ends of all standing members, as they are drawn.
std::vector<glm::vec3> drawn(const Scene& scene, const Snapshot& snapshot, const ViewOptions& options) {
  SceneInstances instances(*scene.building);
  instances.update(snapshot, options);
  std::vector<glm::vec3> all;
  for (const auto& batch : instances.members())
    for (const MemberInstance& one : batch.instances) all.push_back(one.displacement1);
  return all;
}

ViewOptions scales(float deflection, float motion) {
  ViewOptions options;
  options.deflection_scale = deflection;
  options.motion_scale = motion;
  return options;
}

}  // namespace

TEST_CASE("motion is drawn by its own scale: what the building bore at the start stays as it was") {
  Pushed run;
  const auto moved = run.go(20);
  REQUIRE(moved->membership->members_standing == static_cast<int>(run.scene.building->members.size()));
  const auto u0 = drawn(run.scene, *run.start, scales(1, 1)), u1 = drawn(run.scene, *moved, scales(1, 1));
  const auto both = drawn(run.scene, *moved, scales(10, 200));
  REQUIRE(both.size() == u0.size());
  float largest = 0, moves = 0;
  for (std::size_t i = 0; i < both.size(); ++i) {
    const glm::vec3 expected = 10.0F * u0[i] + 200.0F * (u1[i] - u0[i]);
    const glm::vec3 off = both[i] - expected;
    for (int c = 0; c < 3; ++c) {
      largest = std::max(largest, std::abs(off[c]));
      moves = std::max(moves, 200 * std::abs(u1[i][c] - u0[i][c]));
    }
  }
  CHECK(moves > 0.5F);     // it is seen: half a metre
  CHECK(largest < 1e-4F);  // single precision, of metres
  CHECK(drawn(run.scene, *run.start, scales(10, 200)) == drawn(run.scene, *run.start, scales(10, 10)));
  // Nobody chose one: as the deflection.
  CHECK(drawn(run.scene, *moved, scales(7, ViewOptions::as_deflection)) == drawn(run.scene, *moved, scales(7, 7)));
  // A run that is looked back at, or taken up again from its beginning, began where it began.
  const Snapshot back = run.session.recording()->at(moved->time);
  CHECK(drawn(run.scene, back, scales(10, 200)) == both);
  run.session.return_to(moved->step);
  CHECK(drawn(run.scene, *run.session.snapshot(), scales(10, 200)) == both);
}

TEST_CASE("motion-scale is a word, and goes back to that of the deflection") {
  ViewOptions options;
  ModeView mode;
  show("motion-scale 40", options, mode);
  CHECK(options.motion_scale == 40);
  CHECK(options.motion_scale_now() == 40);
  show("no motion-scale", options, mode);
  show("deflection 3", options, mode);
  CHECK(options.motion_scale_now() == 3);
}

TEST_CASE("a joint's history keeps the peaks of a frame that sways, however long the run is") {
  const Scene scene = open_scene("seed_building");
  Recording recording;
  Snapshot snapshot = undeformed(*scene.building);
  const topple::structure::JointId joint(0u);
  // A use that swings ten times a second with one peak of 0.9: ten points cannot meet it by chance.
  for (int step = 0; step < 1000; ++step) {
    auto answer = std::make_shared<FrameAnswer>(*undeformed(*scene.building).answer);
    answer->joints[0].utilisation = step == 501 ? 0.9F : 0.1F + 0.1F * static_cast<float>(step % 6 == 3);
    snapshot.answer = answer;
    snapshot.step = step;
    snapshot.time = step / 60.0;
    recording.add(snapshot);
  }
  const auto history = recording.history(joint, 10);
  REQUIRE(history.size() == 10);
  CHECK(std::count_if(history.begin(), history.end(), [](const auto& p) { return p[1] == 0.9F; }) == 1);
  // It came at 8.35 s, in the interval that ends at 9.25 s.
  const auto peak = std::max_element(history.begin(), history.end(), [](auto& a, auto& b) { return a[1] < b[1]; });
  CHECK(std::abs((*peak)[0] - 5 * 999 / 60.0 / 9) < 1e-4);
  CHECK(history[3][1] == 0.2F);
}

TEST_CASE("energies are kept over the run: those of the ledger, of what stands and moves among them") {
  Pushed run;
  const auto moved = run.go(90);
  const Ledger ledger = run.session.simulation().ledger();
  CHECK(moved->energies.kinetic_standing == ledger.kinetic_standing);
  CHECK(moved->energies.damped == ledger.damped);
  const auto points = run.session.recording()->energies();
  REQUIRE(points.size() > 60);
  CHECK(points.back().time == moved->time);
  CHECK(points.back().ledger.elastic == ledger.elastic);
  CHECK(run.session.recording()->at(moved->time).energies.damped == ledger.damped);
  // It swings: what it moves with comes and goes, what is damped only grows, and the work put in is in them.
  const auto curve = [&](std::size_t c) {
    std::vector<double> values;
    for (const auto& p : points) values.push_back(energy_curves()[c].value(p.ledger, points.front().ledger));
    return values;
  };
  const std::vector<double> moving = curve(0), elastic = curve(1), damped = curve(2);
  const auto fastest = std::max_element(moving.begin(), moving.end());
  CHECK(*fastest > 10);
  CHECK(*std::min_element(fastest, moving.end()) < 0.2 * *fastest);
  CHECK(elastic.front() == 0);
  CHECK(std::is_sorted(damped.begin(), damped.end()));
  CHECK(damped.back() > 0);
}
