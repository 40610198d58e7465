// Pictures drawn without a window, judged by what must be seen in them.
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <optional>
#include <stdexcept>

#include "renderer/picture_renderer.h"
#include "topple/structure/formats/files.h"

namespace {

using namespace topple::viewer;
using topple::structure::Building;

constexpr int width = 320, height = 180;

/// Skips (empty) where no picture can be drawn without a window.
std::unique_ptr<PictureRenderer> renderer_for(const Building& building) {
  try {
    return std::make_unique<PictureRenderer>(building, 0.0, width, height);
  } catch (const std::runtime_error& error) {
    std::cout << "SKIPPED: " << error.what() << '\n';
    return nullptr;
  }
}

Building seed() { return topple::structure::read_model(topple::structure::find_model("seed_building")); }

struct Colour {
  int red, green, blue;
};
Colour at(const Image& image, int x, int y) {
  const std::uint8_t* p = image.at(x, y);
  return {p[0], p[1], p[2]};
}

template <class Accept>
double share(const Image& image, Accept accept) {
  int count = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) count += accept(at(image, x, y)) ? 1 : 0;
  return static_cast<double>(count) / (image.width * image.height);
}
bool differs(Colour a, Colour b) {
  return std::abs(a.red - b.red) + std::abs(a.green - b.green) + std::abs(a.blue - b.blue) > 24;
}
double changed(const Image& a, const Image& b) {
  int count = 0;
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x) count += differs(at(a, x, y), at(b, x, y)) ? 1 : 0;
  return static_cast<double>(count) / (a.width * a.height);
}
bool saturated_blue(Colour c) { return c.blue > 110 && c.blue > 2 * c.red && c.blue > c.green + 40; }
bool red(Colour c) { return c.red > 100 && c.red > 2 * c.green && c.red > 2 * c.blue; }
bool green(Colour c) { return c.green > 80 && c.green > c.red + 40 && c.green > c.blue + 40; }

FrameAnswer::Joint used(float force, float torque) {
  FrameAnswer::Joint joint;
  joint.force_share = force;
  joint.torque_share = torque;
  joint.utilisation = std::max(force, torque);
  return joint;
}

/// The undeformed building with every member's joints in one state.
Snapshot with_joints(const Building& building, const FrameAnswer::Joint& state) {
  Snapshot snapshot = undeformed(building);
  auto answer = std::make_shared<FrameAnswer>(*snapshot.answer);
  for (std::size_t j = 0; j < 2 * building.members.size(); ++j) answer->joints[j] = state;
  snapshot.answer = answer;
  return snapshot;
}

ViewOptions bare_frame() {
  ViewOptions options;
  options.colouring = Colouring::joints;
  options.shown.slabs = options.shown.walls = false;
  return options;
}

}  // namespace

TEST_CASE("a picture has sky above, ground below, and the building between") {
  const Building building = seed();
  const auto renderer = renderer_for(building);
  if (!renderer) return;
  const Camera camera = renderer->default_camera();
  const Image image = renderer->draw(undeformed(building), camera);
  const Colour sky = at(image, width / 2, 1), ground = at(image, 8, height - 8);
  CHECK(sky.blue > sky.red + 10);                   // the sky is bluish
  CHECK(std::abs(ground.red - ground.green) < 40);  // the ground is of stone or dry grass, and lit
  CHECK(ground.red > ground.blue);
  CHECK(ground.green > 100);
  // What differs from the same view with all parts switched off is the building (and its shadow). Framed with a margin
  // of 12 %, a box of about 18 x 24 x 21 covers a third to a half of a 16:9 picture.
  ViewOptions nothing;
  nothing.shown = {false, false, false, false, false};
  const double covered = changed(image, renderer->draw(undeformed(building), camera, nothing));
  CHECK(covered > 0.25);
  CHECK(covered < 0.65);
}

TEST_CASE("switches hide posts, beams, slabs and walls one by one") {
  const Building building = seed();
  const auto renderer = renderer_for(building);
  if (!renderer) return;
  const Camera camera = renderer->default_camera();
  ViewOptions options;
  Image before = renderer->draw(undeformed(building), camera, options);
  for (bool PartSwitches::*part :
       {&PartSwitches::walls, &PartSwitches::slabs, &PartSwitches::beams, &PartSwitches::posts}) {
    options.shown.*part = false;
    const Image after = renderer->draw(undeformed(building), camera, options);
    CHECK(changed(before, after) > 0.01);
    before = after;
  }
}

TEST_CASE("joints are coloured red by force, green by torque, blue when they failed") {
  const Building building = seed();
  const auto renderer = renderer_for(building);
  if (!renderer) return;
  const Camera camera = renderer->default_camera();
  const ViewOptions options = bare_frame();
  FrameAnswer::Joint failed;
  failed.intact = false;
  const Image by_force = renderer->draw(with_joints(building, used(0.95F, 0.05F)), camera, options);
  const Image by_torque = renderer->draw(with_joints(building, used(0.05F, 0.95F)), camera, options);
  const Image by_failure = renderer->draw(with_joints(building, failed), camera, options);
  const Image unused = renderer->draw(with_joints(building, used(0, 0)), camera, options);
  CHECK(share(by_force, red) > 0.005);
  CHECK(share(by_torque, green) > 0.005);
  CHECK(share(by_failure, saturated_blue) > 0.005);
  for (const auto& accept : {red, green, saturated_blue}) CHECK(share(unused, accept) == 0);
  // Hidden on demand.
  ViewOptions hidden = options;
  hidden.failed_joints = false;
  CHECK(share(renderer->draw(with_joints(building, failed), camera, hidden), saturated_blue) == 0);
}

TEST_CASE("a displaced building is drawn displaced by the scale") {
  const Building building = seed();
  const auto renderer = renderer_for(building);
  if (!renderer) return;
  const Camera camera = renderer->default_camera();
  Snapshot snapshot = undeformed(building);
  auto answer = std::make_shared<FrameAnswer>(*snapshot.answer);
  for (auto& d : answer->displacements) d[2] = -0.5F;  // all of it sinks by half a metre
  snapshot.answer = answer;
  ViewOptions options = bare_frame();
  options.deflection_scale = 0;
  const Image still = renderer->draw(snapshot, camera, options);
  CHECK(changed(still, renderer->draw(undeformed(building), camera, options)) == 0);
  options.deflection_scale = 1;
  CHECK(changed(still, renderer->draw(snapshot, camera, options)) > 0.02);
}

TEST_CASE("a detached part is drawn where its body is") {
  const Building building = seed();
  const auto renderer = renderer_for(building);
  if (!renderer) return;
  const Camera camera = renderer->default_camera();
  Snapshot snapshot = undeformed(building);
  auto membership = std::make_shared<Membership>(*snapshot.membership);
  for (int& place : membership->member) place = 0;
  snapshot.membership = membership;
  BodyPose body;
  body.id = 0;
  snapshot.bodies = {body};
  const ViewOptions options = bare_frame();
  const Image standing = renderer->draw(undeformed(building), camera, options);
  CHECK(changed(standing, renderer->draw(snapshot, camera, options)) < 0.002);  // in its rest pose: the same picture
  snapshot.bodies[0].position.x() += 8;
  CHECK(changed(standing, renderer->draw(snapshot, camera, options)) > 0.05);
}

TEST_CASE("a projectile is seen where it is") {
  const Building building = seed();
  const auto renderer = renderer_for(building);
  if (!renderer) return;
  const Camera camera = renderer->default_camera();
  Snapshot snapshot = undeformed(building);
  BodyPose ball;
  ball.id = 0;
  ball.radius = 1.0;
  const glm::dvec3 place = camera.eye + 0.4 * (camera.target - camera.eye);
  ball.position = {place.x, place.y, place.z};
  snapshot.bodies = {ball};
  const Image image = renderer->draw(snapshot, camera);
  const Colour middle = at(image, width / 2, height / 2);
  CHECK(middle.red < 110);
  CHECK(middle.green < 110);
}
