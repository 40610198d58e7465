// The camera by elementary geometry: where points are seen, where pixels look, what framing leaves free.
#include "renderer/camera.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <glm/geometric.hpp>

namespace {

using topple::viewer::Bounds;
using topple::viewer::Camera;

constexpr glm::dvec2 size{1280, 720};

Bounds box(glm::dvec3 low, glm::dvec3 high) {
  Bounds bounds;
  bounds.low = low;
  bounds.high = high;
  return bounds;
}

}  // namespace

TEST_CASE("the target is seen in the middle, and a pixel's ray meets what is seen there") {
  Camera camera;
  camera.eye = {30, -40, 15};
  camera.target = {5, 5, 8};
  const glm::dvec3 middle = camera.project(camera.target, size);
  CHECK(middle.x == Approx(640));
  CHECK(middle.y == Approx(360));
  CHECK(middle.z == Approx(camera.distance()));
  const glm::dvec3 point{9, -3, 11}, seen = camera.project(point, size);
  const topple::viewer::Ray ray = camera.ray(glm::dvec2(seen), size);
  CHECK(glm::length(glm::cross(point - ray.origin, ray.direction)) < 1e-9);
  // The matrices that draw agree with it (single precision: a hundredth of a pixel).
  const glm::vec4 clip = camera.projection(size.x / size.y, 1, 100) * camera.view(glm::dvec3(0)) * glm::vec4(point, 1);
  CHECK((clip.x / clip.w * 0.5 + 0.5) * size.x == Approx(seen.x).margin(0.01));
  CHECK((0.5 - clip.y / clip.w * 0.5) * size.y == Approx(seen.y).margin(0.01));
}

TEST_CASE("framing shows every corner and fills the picture up to the margin") {
  for (const Bounds& bounds :
       {box({0, 0, 0}, {18, 24, 21}), box({100, -50, 0}, {160, 10, 160}), box({0, 0, 0}, {80, 1, 3})}) {
    const Camera camera = topple::viewer::frame(bounds, size.x / size.y, 0.1);
    double widest = 0;
    for (unsigned i = 0; i < 8; ++i) {
      const glm::dvec3 corner((i & 1U) != 0 ? bounds.high.x : bounds.low.x,
                              (i & 2U) != 0 ? bounds.high.y : bounds.low.y,
                              (i & 4U) != 0 ? bounds.high.z : bounds.low.z);
      const glm::dvec3 seen = camera.project(corner, size);
      CHECK(seen.z > 0);
      widest = std::max({widest, std::abs(seen.x / size.x * 2 - 1), std::abs(seen.y / size.y * 2 - 1)});
    }
    CHECK(widest == Approx(0.9).margin(1e-6));  // one corner at least touches the margin
  }
}

TEST_CASE("orbiting keeps the distance, stays above the ground and never passes over the pole") {
  Camera camera;
  camera.eye = {20, 0, 10};
  camera.target = {0, 0, 5};
  const double distance = camera.distance();
  for (int i = 0; i < 50; ++i) camera.orbit(0.3, -0.2, 0.5);
  CHECK(camera.distance() == Approx(distance));
  CHECK(camera.eye.z == Approx(0.5));
  for (int i = 0; i < 50; ++i) camera.orbit(0, 0.3, 0.5);
  CHECK(camera.distance() == Approx(distance));
  CHECK(camera.forward().z > -1);
  CHECK(camera.forward().z < -0.99);
}

TEST_CASE("panning moves the picture with the pointer, zooming keeps its middle") {
  Camera camera;
  camera.eye = {20, -20, 10};
  camera.target = {0, 0, 5};
  const glm::dvec3 point = camera.target;
  camera.pan(-0.25, 0.1);  // the scene moves right by a quarter of the picture's height and down by a tenth
  const glm::dvec3 seen = camera.project(point, size);
  CHECK(seen.x == Approx(640 + 0.25 * 720));
  CHECK(seen.y == Approx(360 + 0.1 * 720));
  const double distance = camera.distance();
  const glm::dvec3 target = camera.target;
  camera.zoom(0.5);
  CHECK(camera.distance() == Approx(distance / 2));
  CHECK(glm::length(camera.target - target) < 1e-12);
}
