#include "renderer/camera.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>

namespace topple::viewer {
namespace {

constexpr glm::dvec3 up{0, 0, 1};
/// The view never comes nearer to the vertical than this (rad), where "right" would lose its meaning.
constexpr double pole = 0.02;

glm::dvec3 direction(double azimuth, double elevation) {
  return {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth), std::sin(elevation)};
}
double azimuth_of(const glm::dvec3& v) { return std::atan2(v.y, v.x); }
double elevation_of(const glm::dvec3& v) { return std::asin(std::clamp(v.z, -1.0, 1.0)); }
double off_pole(double elevation) {
  const double limit = glm::half_pi<double>() - pole;
  return std::clamp(elevation, -limit, limit);
}

}  // namespace

double Bounds::radius() const { return glm::length(high - low) * 0.5; }

glm::dvec3 Camera::forward() const { return glm::normalize(target - eye); }
glm::dvec3 Camera::right() const { return glm::normalize(glm::cross(forward(), up)); }
double Camera::distance() const { return glm::length(target - eye); }

void Camera::orbit(double azimuth, double elevation, double lowest) {
  const double radius = distance();
  const glm::dvec3 arm = -forward();
  double rise = off_pole(elevation_of(arm) + elevation);
  const double least = (lowest - target.z) / radius;
  if (std::abs(least) < 1) rise = std::max(rise, std::asin(least));
  eye = target + radius * direction(azimuth_of(arm) + azimuth, rise);
}

void Camera::turn_view(double azimuth, double elevation) {
  const double radius = distance();
  const glm::dvec3 ahead = forward();
  target = eye + radius * direction(azimuth_of(ahead) + azimuth, off_pole(elevation_of(ahead) + elevation));
}

void Camera::zoom(double factor) { eye = target + (eye - target) * factor; }

void Camera::pan(double to_right, double upwards) {
  const double height = 2 * distance() * std::tan(field_of_view / 2);
  const glm::dvec3 move = height * (to_right * right() + upwards * glm::cross(right(), forward()));
  eye += move;
  target += move;
}

void Camera::fly(double ahead, double to_right, double upwards) {
  const glm::dvec3 move = ahead * forward() + to_right * right() + upwards * up;
  eye += move;
  target += move;
}

glm::mat4 Camera::view(const glm::dvec3& origin) const {
  return glm::mat4(glm::lookAt(eye - origin, target - origin, up));
}

glm::mat4 Camera::projection(double aspect, double near, double far) const {
  return glm::mat4(glm::perspective(field_of_view, aspect, near, far));
}

Ray Camera::ray(glm::dvec2 pixel, glm::dvec2 size) const {
  const double half = std::tan(field_of_view / 2);
  const double x = (2 * pixel.x / size.x - 1) * half * size.x / size.y, y = (1 - 2 * pixel.y / size.y) * half;
  return {eye, glm::normalize(forward() + x * right() + y * glm::cross(right(), forward()))};
}

glm::dvec3 Camera::project(const glm::dvec3& point, glm::dvec2 size) const {
  const glm::dvec3 arm = point - eye;
  const double depth = glm::dot(arm, forward()), scale = size.y / (2 * std::tan(field_of_view / 2) * depth);
  return {size.x / 2 + scale * glm::dot(arm, right()),
          size.y / 2 - scale * glm::dot(arm, glm::cross(right(), forward())), depth};
}

namespace {

std::array<glm::dvec3, 8> corners_of(const Bounds& bounds) {
  std::array<glm::dvec3, 8> corners;
  for (unsigned i = 0; i < 8; ++i)
    corners[i] = glm::dvec3((i & 1U) != 0 ? bounds.high.x : bounds.low.x, (i & 2U) != 0 ? bounds.high.y : bounds.low.y,
                            (i & 4U) != 0 ? bounds.high.z : bounds.low.z);
  return corners;
}

/// Puts the eye where all corners just fit, seen along -out.
void step_back(Camera& camera, const Bounds& bounds, const glm::dvec3& out, double half_width, double half_height) {
  camera.eye = camera.target + out;
  const glm::dvec3 side = camera.right(), above = glm::cross(side, camera.forward());
  double distance = 0.05 * bounds.radius();
  for (const glm::dvec3& corner : corners_of(bounds)) {
    const glm::dvec3 p = corner - camera.target;
    const double needed =
        std::max(std::abs(glm::dot(p, side)) / half_width, std::abs(glm::dot(p, above)) / half_height);
    distance = std::max(distance, glm::dot(p, out) + needed);
  }
  camera.eye = camera.target + distance * out;
}

}  // namespace

Camera frame(const Bounds& bounds, double aspect, double margin, double azimuth, double elevation) {
  Camera camera;
  camera.target = bounds.centre();
  const double half_height = std::tan(camera.field_of_view / 2) * (1 - margin), half_width = half_height * aspect;
  // Near corners look larger than far ones: aim at the middle of what is seen, a few times over.
  constexpr int rounds = 6;
  for (int round = 0; round < rounds; ++round) {
    step_back(camera, bounds, direction(azimuth, elevation), half_width, half_height);
    glm::dvec2 low(std::numeric_limits<double>::max()), high(-low);
    for (const glm::dvec3& corner : corners_of(bounds)) {
      const glm::dvec2 seen(camera.project(corner, {aspect, 1.0}));
      low = glm::min(low, seen);
      high = glm::max(high, seen);
    }
    const glm::dvec2 off = (low + high) * 0.5 - glm::dvec2(aspect / 2, 0.5);
    const double height = 2 * camera.distance() * std::tan(camera.field_of_view / 2);
    camera.target += height * (off.x * camera.right() - off.y * glm::cross(camera.right(), camera.forward()));
  }
  step_back(camera, bounds, direction(azimuth, elevation), half_width, half_height);
  return camera;
}

Camera along_path(const std::vector<Camera>& views, double at) {
  const auto last = static_cast<double>(views.size() - 1);
  if (last <= 0) return views.front();
  // Slow at both ends: the first and the last half of a leg are eased.
  double way = std::clamp(at, 0.0, last);
  const auto eased = [](double x) { return x * x * (3 - 2 * x); };
  if (last < 2)
    way = last * eased(way / last);
  else if (way < 1)
    way = way * way * (2 - way);
  else if (const double left = last - way; left < 1)
    way = last - left * left * (2 - left);
  const auto first = std::min(static_cast<std::size_t>(way), views.size() - 2);
  const double t = way - static_cast<double>(first);
  const auto& a = views[first == 0 ? 0 : first - 1];
  const auto &b = views[first], &c = views[first + 1], &d = views[std::min(first + 2, views.size() - 1)];
  const auto spline = [t](const auto& p0, const auto& p1, const auto& p2, const auto& p3) {
    return 0.5 *
           (2.0 * p1 + t * (p2 - p0 + t * (2.0 * p0 - 5.0 * p1 + 4.0 * p2 - p3 + t * (3.0 * p1 - p0 - 3.0 * p2 + p3))));
  };
  Camera camera = b;
  camera.eye = spline(a.eye, b.eye, c.eye, d.eye);
  camera.target = spline(a.target, b.target, c.target, d.target);
  camera.field_of_view = b.field_of_view + t * (c.field_of_view - b.field_of_view);
  return camera;
}

}  // namespace topple::viewer
