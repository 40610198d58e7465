#pragma once
// What an animation holds, before it is written: meshes, and nodes whose poses and visibility are keyed by frame.
// Everything is in the building's axes (z up).
#include <Eigen/Geometry>
#include <array>
#include <string>
#include <vector>

#include "topple/structure/building.h"

namespace topple::structure {

/// Where a node is in a frame.
struct AnimatedPose {
  Vec3 position = Vec3::Zero();                                     ///< m
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();  ///< unit
  /// Equal to the bit.
  bool operator==(const AnimatedPose& other) const {
    return position == other.position && orientation.coeffs() == other.orientation.coeffs();
  }
};

/// How much of each of SceneMesh::bends: as many as glTF asks every program to bear.
using BendWeights = std::array<float, 8>;

/// A node of the scene: one mesh, moved, bent and shown by frames.
struct AnimatedNode {
  std::string name;                                 ///< of the glTF node
  int mesh = -1;                                    ///< index in AnimatedScene::meshes; -1: none
  std::vector<std::pair<int, AnimatedPose>> poses;  ///< by frame, ascending
  std::vector<std::pair<int, BendWeights>> bends;   ///< by frame, ascending; empty: it is never bent
  std::vector<std::pair<int, bool>> visible;        ///< from that frame on; the first is frame 0

  /// A key for this frame, unless the pose is that of the last key.
  void pose(int frame, const AnimatedPose& now);
  /// The same of how it is bent. One that was never bent so far has been straight.
  void bend(int frame, const BendWeights& now);
  /// A key for this frame, unless the node was shown (hidden) already.
  void show(int frame, bool now);
};

/// A triangle mesh of the scene.
struct SceneMesh {
  std::vector<Vec3> positions;                ///< m, about the node
  std::vector<Vec3> normals;                  ///< unit, outwards
  std::vector<Vec2> texture;                  ///< coordinates; empty: none
  std::vector<std::array<int, 3>> triangles;  ///< three vertices each, counter-clockwise from outside
  /// Ways in which it bends, at most as many as BendWeights: how far each vertex goes for a weight of 1. Empty: none.
  std::vector<std::vector<Vec3>> bends;
  /// How much is added to each normal for a weight of 1, to first order; as many as `bends`, or empty: they stay.
  std::vector<std::vector<Vec3>> bend_normals;
  int material = 0;  ///< index in AnimatedScene::materials
};

/// All that a glTF animation holds.
struct AnimatedScene {
  double rate = 30;                                                     ///< frames per second
  std::vector<std::pair<std::string, std::array<float, 3>>> materials;  ///< name and colour
  std::vector<SceneMesh> meshes;                                        ///< shared by nodes
  std::vector<AnimatedNode> nodes;                                      ///< in the order of the file
};

/// `segments`: even parts along x, so that it can be bent.
[[nodiscard]] SceneMesh box_mesh(const Vec3& half, int material, int segments = 1);
[[nodiscard]] SceneMesh sphere_mesh(double radius, int material);
[[nodiscard]] std::string glb_of(const AnimatedScene& scene);

}  // namespace topple::structure
