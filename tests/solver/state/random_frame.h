#pragma once
// A frame with one of each: walls, a patch, supports that are springs, and a floor that is a diaphragm.
#include <random>

#include "frames.h"

namespace topple::test {

/// What a random frame has beside its beams.
struct FrameParts {
  bool walls = false, patch = false, diaphragm = false;
};

inline Vec6 pinned() { return components(rigid, rigid, rigid, 0, 0, 0); }

/// The same stiffness between any two of the nodes, in every freedom.
inline Eigen::MatrixXd patch_of_springs(std::size_t nodes, double stiffness) {
  const auto size = static_cast<Eigen::Index>(6 * nodes);
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(size, size);
  for (Eigen::Index a = 0; a < size; a += 6)
    for (Eigen::Index b = 0; b < size; b += 6) {
      const double factor = a == b ? static_cast<double>(nodes) - 1 : -1.0;
      K.block<6, 6>(a, b) = factor * stiffness * Mat6::Identity();
    }
  return K;
}

inline FrameModel random_frame(int posts, int storeys, const FrameParts& parts, std::mt19937& random) {
  std::uniform_real_distribution<double> share(0, 1);
  FrameModel model = tower(posts, storeys);
  const int floor = posts * posts;
  for (Beam& beam : model.beams) {
    const double size = 0.5 + share(random);
    beam.area *= size;
    beam.Iy *= size * size;
    beam.Iz *= size * size;
    beam.J *= size * size;
    beam.density = 7850;
  }
  for (int k = 0; parts.walls && k < storeys; ++k) {
    const int foot = k * floor;
    model.shells.push_back({{foot, foot + 1, foot + floor + 1, foot + floor}, 30e9, 0.2, 0.2, 2400, k % 2 == 0});
  }
  if (parts.patch) {
    const std::vector<int> nodes{floor + 1, 2 * floor + 1, 2 * floor + 2};
    model.patches.push_back({nodes, patch_of_springs(3, 1e7), {}});
  }
  if (parts.diaphragm) {
    Diaphragm top;
    for (int n = 0; n < floor; ++n) top.nodes.push_back(storeys * floor + n);
    model.diaphragms.push_back(top);
  }
  model.supports.push_back({floor, components(1e6, 0, 0, 0, 1e5, 0)});
  return model;
}

}  // namespace topple::test
