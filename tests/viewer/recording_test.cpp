// A run that is looked back at: the same poses as when it was live, also after it was taken up again.
#include <catch2/catch.hpp>

#include "app/driver.h"
#include "app/open_scene.h"

namespace {

using namespace topple::viewer;

/// The seed building with a post shot away, for a while.
struct Run {
  Scene scene = open_scene("seed_building");
  Session session{scene.building, scene.scenario};
  DirectDriver driver{session};
  void go(int steps) {
    for (int i = 0; i < steps; ++i) driver.advance();
  }
  void shoot() {
    topple::structure::Projectile shot;
    shot.from = {-12, 0, 1.8};
    shot.velocity = {80, 0, 0};
    shot.mass = 2000;
    driver.apply(shot);
  }
};

void check_same(const Snapshot& a, const Snapshot& b) {
  CHECK(a.step == b.step);
  CHECK(a.answer == b.answer);
  CHECK(a.membership == b.membership);
  REQUIRE(a.bodies.size() == b.bodies.size());
  for (std::size_t i = 0; i < a.bodies.size(); ++i) {
    CHECK(a.bodies[i].id == b.bodies[i].id);
    // Recorded in single precision, as a way of at most some tens of metres.
    CHECK((a.bodies[i].position - b.bodies[i].position).norm() < 1e-4);
    CHECK(a.bodies[i].orientation.angularDistance(b.bodies[i].orientation) < 1e-3);
  }
}

}  // namespace

TEST_CASE("looking back shows what was seen live") {
  Run run;
  run.go(5);
  run.shoot();
  std::vector<std::shared_ptr<const Snapshot>> seen;
  for (int i = 0; i < 90; ++i) {
    run.go(1);
    seen.push_back(run.driver.moment().later);
  }
  REQUIRE(seen.back()->bodies.size() > 1);  // something has come off
  for (const std::size_t i : {0U, 20U, 40U, 60U, 89U}) check_same(run.driver.recording().at(seen[i]->time), *seen[i]);
  CHECK(run.driver.recording().span()[1] == seen.back()->time);
  // Between two frames, between their poses.
  const Snapshot between = run.driver.recording().at((seen[10]->time + seen[11]->time) / 2);
  CHECK(between.bodies[0].position.x() ==
        Approx((seen[10]->bodies[0].position.x() + seen[11]->bodies[0].position.x()) / 2).margin(1e-4));
}

TEST_CASE("what rests takes no room in a recording") {
  Run run;
  run.go(300);
  CHECK(run.driver.recording().frames().size() <= 6);
  CHECK(run.driver.recording().span()[1] == Approx(300 * run.scene.scenario.step));
}

TEST_CASE("a run goes on from a step that it has passed, and what came after is forgotten") {
  Run run;
  run.go(5);
  run.shoot();
  run.go(60);
  const Snapshot then = *run.driver.moment().later;
  const std::uint64_t hash = run.session.simulation().hash();
  const std::size_t events = run.driver.recording().events().size();
  run.go(40);
  CHECK(run.session.simulation().hash() != hash);
  run.driver.order_and_show([&](Session& session) { session.return_to(then.step); });
  CHECK(run.session.simulation().hash() == hash);
  CHECK(run.driver.recording().span()[1] == then.time);
  CHECK(run.driver.recording().events().size() == events);
  run.go(40);
  CHECK(run.driver.recording().span()[1] == Approx(then.time + 40 * run.scene.scenario.step));
}

TEST_CASE("events are recorded with their words, and a joint's utilisation over time") {
  Run run;
  run.go(5);
  run.shoot();
  run.go(90);
  const auto events = run.driver.recording().events();
  REQUIRE(events.size() > 3);
  bool shot = false, broke = false;
  for (const auto& event : events) {
    shot = shot || event.text == "projectile";
    broke = broke || event.text.find(" breaks: ") != std::string::npos;
  }
  CHECK(shot);
  CHECK(broke);
  const auto joint = topple::structure::NameIndex(*run.scene.building).joint("P-2-1-1:1");
  const auto history = run.driver.recording().history(*joint);
  REQUIRE(history.size() > 10);
  CHECK(history.front()[1] != history.back()[1]);  // the neighbour of the lost post bears more, or broke
}
