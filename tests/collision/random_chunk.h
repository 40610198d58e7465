#pragma once
// Debris as a broken panel leaves it.
#include <cmath>
#include <random>

#include "world_builder.h"

namespace collision_test {

/// A prism of five to seven corners, 0.2 m thick.
inline BodyDescription chunk(std::mt19937& random, const Vec3& at) {
  const auto between = [&](double low, double high) { return low + (high - low) * (random() % 1000) / 1000.0; };
  const int corners = 5 + static_cast<int>(random() % 3);
  BodyDescription body = box_body({0.4, 0.4, 0.1}, 250, at);
  ConvexPart part;
  part.kind = ConvexPart::Kind::hull;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2 * M_PI * (i + between(-0.2, 0.2)) / corners, size = between(0.4, 0.55);
    for (const double side : {-0.1, 0.1})
      part.points.emplace_back(size * std::cos(angle), size * std::sin(angle), side);
  }
  body.parts = {part};
  body.pose.orientation =
      Eigen::Quaterniond(between(-1, 1), between(-1, 1), between(-1, 1), between(-1, 1)).normalized();
  return body;
}

}  // namespace collision_test
