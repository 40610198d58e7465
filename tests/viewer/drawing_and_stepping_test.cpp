// Drawing and the simulation side by side: neither waits for the other, and pictures between steps are interpolated.
#include <catch2/catch.hpp>
#include <future>
#include <iostream>
#include <memory>
#include <stdexcept>

#include "app/controller.h"
#include "app/driver.h"
#include "app/interface.h"
#include "app/side_panel.h"
#include "renderer/headless_context.h"

namespace {

using namespace topple::viewer;

std::unique_ptr<Session> seed_session() {
  const Scene scene = open_scene("seed_building");
  return std::make_unique<Session>(scene.building, scene.scenario);
}

}  // namespace

TEST_CASE("a picture is drawn while a step takes its time") {
  ThreadDriver driver(seed_session());
  std::promise<void> begun, drawn;
  driver.order([&](Session&) {
    begun.set_value();
    drawn.get_future().wait();  // a step that ends only when a picture has been drawn
  });
  begun.get_future().wait();
  const Snapshot moment = driver.moment().interpolated();
  CHECK(moment.answer);
  driver.set_paused(true);
  drawn.set_value();
  CHECK(driver.error().empty());
}

TEST_CASE("between two steps, a body is drawn between its poses") {
  Snapshot earlier, later;
  earlier.step = 4, later.step = 5;
  earlier.time = 1.0, later.time = 1.2;
  BodyPose body;
  body.id = 3;
  earlier.bodies = {body};
  body.position = {2, 0, 0};
  body.orientation = Eigen::AngleAxisd(0.8, Eigen::Vector3d::UnitZ());
  later.bodies = {body};
  const Moment moment{std::make_shared<Snapshot>(earlier), std::make_shared<Snapshot>(later), 0.25};
  const Snapshot drawn = moment.interpolated();
  REQUIRE(drawn.bodies.size() == 1);
  CHECK(drawn.bodies[0].position.x() == Approx(0.5));
  CHECK(drawn.bodies[0].orientation.angularDistance(Eigen::Quaterniond::Identity()) == Approx(0.2));
  CHECK(drawn.time == Approx(1.05));
}

TEST_CASE("pause holds the run, a single step makes one, and slow motion is a pace of its own") {
  const std::unique_ptr<Session> session = seed_session();
  DirectDriver driver(*session);
  driver.advance();
  driver.set_paused(true);
  driver.advance();
  CHECK(driver.moment().later->step == 1);
  driver.single_step();
  CHECK(driver.moment().later->step == 2);
  CHECK(driver.paused());
  driver.set_speed(0.1);
  CHECK(driver.speed() == 0.1);
}

TEST_CASE("at twice the pixels, panels take twice the pixels") {
  std::unique_ptr<HeadlessContext> context;
  try {
    context = std::make_unique<HeadlessContext>();
  } catch (const std::runtime_error& error) {
    std::cout << "SKIPPED: " << error.what() << '\n';
    return;
  }
  const auto scene_at = [](float scale, glm::dvec2 window) {
    const Interface interface(scale);
    return SidePanel::scene_size(window);
  };
  const glm::dvec2 usual = scene_at(1, {1920, 1080}), fine = scene_at(2, {3840, 2160});
  CHECK(fine == 2.0 * usual);
  // At 1080p the building has most of the window.
  CHECK(usual.x * usual.y > 0.7 * 1920 * 1080);
}
