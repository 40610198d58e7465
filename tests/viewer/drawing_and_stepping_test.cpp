// Drawing and the simulation side by side: neither waits for the other, and pictures between steps are interpolated.
#include <atomic>
#include <catch2/catch.hpp>
#include <chrono>
#include <ctime>
#include <future>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <thread>

#include "app/controller.h"
#include "app/driver.h"
#include "app/interface.h"
#include "app/side_panel.h"
#include "renderer/frame_composer.h"
#include "renderer/gl_errors.h"
#include "renderer/headless_context.h"
#include "topple/structure/error.h"

namespace {

using namespace topple::viewer;

std::unique_ptr<Session> seed_session() {
  const Scene scene = open_scene("seed_building");
  return std::make_unique<Session>(scene.building, scene.scenario);
}

/// Of this thread.
double processor_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace

TEST_CASE("a picture is drawn while a step takes its time") {
  std::promise<void> begun, drawn;  // outlive the driver, whose thread uses them
  ThreadDriver driver(seed_session());
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

TEST_CASE("a building is seen unloaded until its first answer is there, and orders wait for that") {
  const Scene scene = open_scene("seed_building");
  std::promise<void> looked;
  std::promise<std::size_t> ordered;
  ThreadDriver driver(*scene.building, scene.scenario.step, [&](std::shared_ptr<Recording> recording) {
    looked.get_future().wait();
    return std::make_unique<Session>(scene.building, scene.scenario, nullptr, std::move(recording));
  });
  CHECK_FALSE(driver.begun());
  const Moment before = driver.moment();
  CHECK(before.later->membership->members_standing == static_cast<int>(scene.building->members.size()));
  for (const auto& displacement : before.later->answer->displacements) CHECK(displacement.isZero(0));
  // The panels look back at any time.
  CHECK(driver.recording().at(0).step == 0);
  driver.set_paused(true);
  driver.order([&](Session& session) { ordered.set_value(session.actions()); });
  looked.set_value();
  CHECK(ordered.get_future().get() == 0);
  CHECK(driver.begun());
  driver.require_beginning();
  // Its own weight moves it, and what was drawn before is not a part of the run.
  const auto standing = driver.moment().later;
  CHECK(standing->step == 0);
  double most = 0;
  for (const auto& moved : standing->answer->displacements) most = std::max(most, double{moved.head<3>().norm()});
  CHECK(most > 1e-5);
  CHECK(driver.recording().frames().size() == 1);
  CHECK(driver.recording().at(0).answer == standing->answer);
}

TEST_CASE("why a run cannot begin is told as what was thrown") {
  const Scene scene = open_scene("seed_building");
  const ThreadDriver driver(*scene.building, scene.scenario.step, [](const auto&) -> std::unique_ptr<Session> {
    throw topple::structure::UnstableModel("node N sways");
  });
  while (driver.error().empty()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  CHECK_THROWS_AS(driver.require_beginning(), topple::structure::UnstableModel);
  CHECK_FALSE(driver.begun());
  CHECK(driver.moment().later->step == 0);
}

TEST_CASE("sixty pictures a second, with their panels, are made while one step takes two seconds") {
  std::unique_ptr<HeadlessContext> context;
  try {
    context = std::make_unique<HeadlessContext>();
  } catch (const std::runtime_error& error) {
    std::cout << "SKIPPED: " << error.what() << '\n';
    return;
  }
  constexpr int pictures = 120;
  constexpr double longest = 60;  // s: a test that fails must end
  std::atomic<int> drawn = 0;
  std::promise<void> begun;
  const auto slow = [&, first = true]() mutable {
    if (!std::exchange(first, false)) return;
    begun.set_value();
    for (double waited = 0; waited < longest && (waited < 2 || drawn < pictures); waited += 0.01)
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
  };
  const Scene scene = open_scene("seed_hit");
  ThreadDriver driver(std::make_unique<Session>(scene.building, scene.scenario), slow);
  const glm::dvec2 size(1280, 720);
  Controller controller(driver, scene, 0, size);
  SceneInstances instances(*scene.building);
  const FrameComposer corner({16, 16});  // what a card would draw is not measured
  Interface interface(1);
  SidePanel panel;
  begun.get_future().wait();
  const double before = processor_seconds();
  while (drawn < pictures) {
    controller.update(1.0 / 60);
    const Snapshot moment = controller.shown(false);
    CHECK(moment.step == 0);
    instances.update(moment, controller.options);
    interface.begin_frame(size, 1.0 / 60);
    panel.draw(controller, moment, instances, driver.error());
    draw_hover_text(controller, moment);
    Interface::end_frame();
    if (++drawn == pictures / 2) controller.key("space");
    CHECK(driver.paused() == (drawn >= pictures / 2));  // it answers at once, whatever the step does
  }
  check_gl_errors();
  // What the processor does for a picture; the graphics card's part is drawn by a card.
  CHECK((processor_seconds() - before) / pictures < 1.0 / 60);
  CHECK(driver.error().empty());
}

TEST_CASE("the ratio is what a run behind the window reaches, and nothing while it is paused") {
  ThreadDriver driver(seed_session(), [] { std::this_thread::sleep_for(std::chrono::milliseconds(50)); });
  while (driver.moment().later->step < 4) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  CHECK(driver.ratio() > 0);
  CHECK(driver.ratio() <= 1 / 60.0 / 0.05 + 1e-3);  // steps of 1/60 s that take 1/20 s at least
  driver.set_paused(true);
  CHECK(driver.ratio() == 0);
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
