#pragma once
// What an animation holds, before it is written: meshes, and nodes whose poses and visibility are keyed by frame.
// Everything is in the building's axes (z up).
#include <Eigen/Geometry>
#include <array>
#include <string>
#include <vector>

#include "topple/structure/building.h"

namespace topple::structure {

struct AnimatedPose {
  Vec3 position = Vec3::Zero();
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
  bool operator==(const AnimatedPose& other) const {
    return position == other.position && orientation.coeffs() == other.orientation.coeffs();
  }
};

struct AnimatedNode {
  std::string name;
  int mesh = -1;
  std::vector<std::pair<int, AnimatedPose>> poses;  ///< by frame, ascending
  std::vector<std::pair<int, bool>> visible;        ///< from that frame on; the first is frame 0

  void pose(int frame, const AnimatedPose& now);
  void show(int frame, bool now);
};

struct SceneMesh {
  std::vector<Vec3> positions, normals;
  std::vector<Vec2> texture;  ///< coordinates; empty: none
  std::vector<std::array<int, 3>> triangles;
  int material = 0;
};

struct AnimatedScene {
  double rate = 30;
  std::vector<std::pair<std::string, std::array<float, 3>>> materials;  ///< name and colour
  std::vector<SceneMesh> meshes;
  std::vector<AnimatedNode> nodes;
};

[[nodiscard]] SceneMesh box_mesh(const Vec3& half, int material);
[[nodiscard]] SceneMesh sphere_mesh(double radius, int material);
[[nodiscard]] std::string glb_of(const AnimatedScene& scene);

}  // namespace topple::structure
