// What colours say: shares of capacities, single components, failed joints, and to whom.
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <iostream>
#include <limits>
#include <memory>
#include <stdexcept>

#include "app/open_scene.h"
#include "renderer/instances/scene_instances.h"
#include "renderer/picture_renderer.h"
#include "renderer/shapes/looks.h"
#include "renderer/shapes/palette.h"
#include "support/scratch_folder.h"

namespace {

using namespace topple::viewer;

topple::structure::JointCapacity capacities() {
  topple::structure::JointCapacity capacity;
  capacity.value = {100, 200, 300, 400, 500, 600, 700};  // tension, compression, shears, torsion, moments
  return capacity;
}

/// How colours look to one who lacks the green or the red cones: Machado, Oliveira and Fernandes 2009, severity 1, on
/// linear light (matrices by rows).
const glm::mat3 without_green = glm::transpose(
    glm::mat3(0.367322F, 0.860646F, -0.227968F, 0.280085F, 0.672501F, 0.047413F, -0.011820F, 0.042940F, 0.968881F));
const glm::mat3 without_red = glm::transpose(
    glm::mat3(0.152286F, 1.052583F, -0.204868F, 0.114503F, 0.786281F, 0.099216F, -0.003882F, -0.048116F, 1.051998F));

/// CIE L*a*b* (D65) of a colour seen through a matrix.
glm::vec3 lab(Rgba colour, const glm::mat3& seen) {
  const glm::vec4 c = unpack(colour);
  const auto linear = [](float x) { return x <= 0.04045F ? x / 12.92F : std::pow((x + 0.055F) / 1.055F, 2.4F); };
  const glm::vec3 rgb = seen * glm::vec3(linear(c.r), linear(c.g), linear(c.b));
  const float x = (0.4124F * rgb.r + 0.3576F * rgb.g + 0.1805F * rgb.b) / 0.9505F,
              y = 0.2126F * rgb.r + 0.7152F * rgb.g + 0.0722F * rgb.b,
              z = (0.0193F * rgb.r + 0.1192F * rgb.g + 0.9505F * rgb.b) / 1.089F;
  const auto f = [](float t) { return t > 0.008856F ? std::cbrt(t) : 7.787F * std::max(t, 0.0F) + 16.0F / 116; };
  return {116 * f(y) - 16, 500 * (f(x) - f(y)), 200 * (f(y) - f(z))};
}

/// The least difference between any two of a palette, seen through a matrix.
float least_difference(const JointPalette& p, const glm::mat3& seen) {
  const Rgba all[] = {p.force, p.torque, p.both, p.failed, p.yielded};
  float least = std::numeric_limits<float>::max();
  for (int i = 0; i < 5; ++i)
    for (int j = 0; j < i; ++j) least = std::min(least, glm::length(lab(all[i], seen) - lab(all[j], seen)));
  return least;
}

/// The view in which joints are coloured.
ViewOptions of_joints() {
  ViewOptions options;
  options.colouring = Colouring::joints;
  return options;
}

}  // namespace

TEST_CASE("each of the six components is coloured alone, by its sign and its share of its own capacity") {
  ViewOptions options = of_joints();
  options.colouring = Colouring::component;
  const double limits[] = {100, 300, 400, 500, 600, 700};
  for (int c = 0; c < 6; ++c) {
    CAPTURE(c);
    options.component = c;
    FrameAnswer::Joint joint;
    joint.demand.fill(90);  // the others must not be seen
    joint.demand[static_cast<std::size_t>(c)] = static_cast<float>(0.5 * limits[c]);
    CHECK(joint_colour(joint, capacities(), options, 0) == signed_colour(0.5));
    joint.demand[static_cast<std::size_t>(c)] = 0;
    CHECK(joint_colour(joint, capacities(), options, 0) == signed_colour(0));
    joint.demand[static_cast<std::size_t>(c)] = -50;
    const double share = c == 0 ? -50.0 / 200 : -50 / limits[c];  // an axial force below zero is compression
    CHECK(joint_colour(joint, capacities(), options, 0) == signed_colour(share));
    // By the largest in view instead.
    options.scale = Scale::largest_in_view;
    CHECK(joint_colour(joint, capacities(), options, 100) == signed_colour(-0.5));
    CHECK(joint_value(joint, options) == 50);
    options.scale = Scale::capacity;
  }
}

TEST_CASE("colours of joints grow with their use, against the capacity or the largest in view") {
  ViewOptions options = of_joints();
  FrameAnswer::Joint joint;
  const auto strength = [&](double largest) { return unpack(joint_colour(joint, capacities(), options, largest)).a; };
  joint.force_share = 0.25F;
  CHECK(strength(0.25) == Approx(0.5).margin(1.0 / 255));  // the root
  joint.force_share = 1;
  CHECK(strength(1) == 1);
  options.scale = Scale::largest_in_view;
  joint.force_share = 0.25F;
  CHECK(strength(0.25) == 1);
  // Hues: force, moment, both alike.
  const JointPalette palette = joint_palette(false);
  const auto hue = [&] { return joint_colour(joint, capacities(), options, 0.25) & 0x00FFFFFFU; };
  CHECK(hue() == (palette.force & 0x00FFFFFFU));
  joint.torque_share = 0.25F;
  CHECK(hue() == (palette.both & 0x00FFFFFFU));
  joint.force_share = 0;
  CHECK(hue() == (palette.torque & 0x00FFFFFFU));
}

TEST_CASE("failed joints are blue, black where blue says something else, or hidden") {
  ViewOptions options = of_joints();
  FrameAnswer::Joint failed;
  failed.intact = false;
  CHECK(joint_colour(failed, capacities(), options, 1) == joint_palette(false).failed);
  for (const Colouring map : {Colouring::component, Colouring::utilisation, Colouring::path, Colouring::segments}) {
    options.colouring = map;
    CHECK(joint_colour(failed, capacities(), options, 1) == rgba(20, 20, 20));
  }
  options.failed_joints = false;
  CHECK(unpack(joint_colour(failed, capacities(), options, 1)).a == 0);
}

TEST_CASE("the colour-blind safe palette is told apart by those who lack green or red, which the usual one is not") {
  // Ten units of L*a*b* are seen at a glance side by side; on thin members it takes about twice that.
  for (const glm::mat3& seen : {glm::mat3(1), without_green, without_red})
    CHECK(least_difference(joint_palette(true), seen) > 20);
  CHECK(std::min(least_difference(joint_palette(false), without_green),
                 least_difference(joint_palette(false), without_red)) < 20);
}

TEST_CASE("coloured members are drawn plain, and their colour fades from the joint") {
  const topple::test::ScratchFolder folder;
  const std::string file = (folder / "post.json").string();
  std::ofstream(file)
      << R"({"topple": 1, "materials": {"steel": {"youngs_modulus": 210e9, "poisson_ratio": 0.3, "density": 7850}},
    "sections": {"post": {"shape": "box", "depth": 0.8, "width": 0.8, "thickness": 0.05}},
    "joints": {"full": {"capacity": {"tension": 1e6, "compression": 1e6, "shear_y": 1e6, "shear_z": 1e6, "torsion": 1e6,
                                     "moment_y": 1e6, "moment_z": 1e6}}},
    "nodes": {"A": [0, 0, 0], "B": [0, 0, 10]},
    "members": {"P": {"kind": "post", "nodes": ["A", "B"], "section": "post", "material": "steel", "joints": ["full", "full"]}},
    "supports": {"A": {"x": true, "y": true, "z": true, "rx": true, "ry": true, "rz": true}},
    "loads": {"dead": {"self_weight": 1}}, "combinations": {"service": {"dead": 1}}})";
  const Scene scene = open_scene(file);
  Snapshot snapshot = undeformed(*scene.building);
  auto answer = std::make_shared<FrameAnswer>(*snapshot.answer);
  for (auto& joint : answer->joints) joint.force_share = 1;
  snapshot.answer = answer;
  SceneInstances instances(*scene.building);
  ViewOptions options = of_joints();
  const auto base = [&] {
    instances.update(snapshot, options);
    return instances.members()[0].instances[0];
  };
  CHECK(base().base == plain_member);
  CHECK(base().end1 == joint_palette(false).force);
  options.coloured.posts = false;
  CHECK(base().base == member_colour(topple::structure::MemberKind::post));
  CHECK(base().end1 == 0);
  options.coloured.posts = true;
  std::unique_ptr<PictureRenderer> renderer;
  try {
    renderer = std::make_unique<PictureRenderer>(*scene.building, 0.0, 120, 240);
  } catch (const std::runtime_error& error) {
    std::cout << "SKIPPED: " << error.what() << '\n';
    return;
  }
  const Image image = renderer->draw(snapshot, renderer->default_camera(), options);
  std::array<int, 3> red{};  // pixels in the upper, middle and lower third of the picture
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const std::uint8_t* p = image.at(x, y);
      red[static_cast<std::size_t>(3 * y / image.height)] += p[0] > 100 && p[0] > 2 * p[1] && p[0] > 2 * p[2] ? 1 : 0;
    }
  CHECK(red[0] > 10);
  CHECK(red[1] == 0);
  CHECK(red[2] > 10);
}

TEST_CASE("a ball is of bare steel where materials are seen, and plain where colours mean something") {
  const topple::structure::Building building = *open_scene("seed_building").building;
  Snapshot snapshot = undeformed(building);
  snapshot.bodies.emplace_back();
  snapshot.bodies.back().radius = 0.4;
  const auto material = [&](Colouring colouring) {
    SceneInstances instances(building);
    ViewOptions options;
    options.colouring = colouring;
    instances.update(snapshot, options);
    REQUIRE(instances.projectiles().instances.size() == 1);
    return instances.projectiles().instances[0].colour >> 24U;
  };
  CHECK(material(Colouring::materials) == static_cast<Rgba>(Look::steel));
  CHECK(material(Colouring::joints) == 255);
}
