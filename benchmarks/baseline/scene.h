#pragma once
// A building as rigid bodies and rigid joints, in plain numbers: what bench_scene writes and the baseline reads.
#include <array>
#include <istream>
#include <string>
#include <vector>

namespace baseline {

using Vec3 = std::array<double, 3>;

struct SceneBody {
  std::string name;
  double mass = 0;                                // kg
  Vec3 half_extents{}, centre{};                  // m
  std::array<double, 4> orientation{1, 0, 0, 0};  // w x y z
  bool ball = false;                              // of the radius half_extents[0]
  Vec3 velocity{}, spin{};                        // m/s, rad/s, global axes
  bool asleep = false;
};

/// Joins `body` to `other` (an index of bodies, -1: the ground) at a point. The force is what the other does to the
/// body, by frame analysis: three forces and three moments about the point, global axes; absent for joints that it does
/// not have.
struct SceneJoint {
  std::string name;
  int body = -1, other = -1;
  Vec3 point{};
  bool has_force = false;
  std::array<double, 6> force{};
};

/// A point at the greatest height, by the body that carries it.
struct RoofPoint {
  int body = -1;
  Vec3 point{};
};

/// A force at a point of a body, global axes: half of it and one and a half of it at alternate steps.
struct ScenePush {
  int body = -1;
  Vec3 point{}, force{};
};

struct Scene {
  double gravity = 0;     // m/s2, downwards
  double static_sag = 0;  // m, mean over the roof points, by frame analysis
  bool has_ground = false;
  double ground = 0;  // height, m
  std::vector<SceneBody> bodies;
  std::vector<SceneJoint> joints;
  std::vector<RoofPoint> roof;
  std::vector<ScenePush> pushes;  // joint forces and sag count them once
};

/// Throws std::runtime_error naming the line.
[[nodiscard]] Scene read_scene(std::istream& in);

}  // namespace baseline
