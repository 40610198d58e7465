#pragma once
// Where the scene is seen from. Global z is up; lengths in the model's unit, angles in radians.
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

namespace topple::viewer {

struct Bounds {
  glm::dvec3 low{0}, high{0};
  [[nodiscard]] glm::dvec3 centre() const { return (low + high) * 0.5; }
  [[nodiscard]] double radius() const;
};

struct Ray {
  glm::dvec3 origin, direction;  ///< direction of length 1
};

struct Camera {
  glm::dvec3 eye{0}, target{0};
  double field_of_view = 0.7;  ///< vertical

  [[nodiscard]] glm::dvec3 forward() const;
  [[nodiscard]] glm::dvec3 right() const;
  [[nodiscard]] double distance() const;

  /// Turns the eye about the target: to the right by `azimuth`, upwards by `elevation`; never over the poles, and not
  /// below `lowest`.
  void orbit(double azimuth, double elevation, double lowest);
  /// Turns the view about the eye, to the left and up.
  void turn_view(double azimuth, double elevation);
  /// Moves the eye towards (below 1) or away from (above 1) the target.
  void zoom(double factor);
  /// Moves eye and target in the picture's plane, in heights of the picture at the target.
  void pan(double to_right, double up);
  /// Moves eye and target along the view, to the right, and up (global z), in lengths.
  void fly(double ahead, double to_right, double up);

  /// With the world moved so that the origin is at `origin` (which keeps single precision fit for far-off models).
  [[nodiscard]] glm::mat4 view(const glm::dvec3& origin) const;
  [[nodiscard]] glm::mat4 projection(double aspect, double near, double far) const;
  /// Through a pixel; (0, 0) is the upper left corner.
  [[nodiscard]] Ray ray(glm::dvec2 pixel, glm::dvec2 size) const;
  /// Pixel where a point is seen; z is its depth along the view (below zero: behind the eye).
  [[nodiscard]] glm::dvec3 project(const glm::dvec3& point, glm::dvec2 size) const;
};

/// From the south-west and a little above, as near as lets all of the box be seen with the share `margin` of the
/// picture left free around it.
[[nodiscard]] Camera frame(const Bounds& bounds, double aspect, double margin = 0.12, double azimuth = -0.95,
                           double elevation = 0.30);

/// A smooth way through places (Catmull and Rom's spline), each reached at a whole number; it starts and ends slowly
/// and is held to its ends. At least one place.
[[nodiscard]] Camera along_path(const std::vector<Camera>& views, double at);

}  // namespace topple::viewer
