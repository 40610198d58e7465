#include "renderer/shapes/hinge_marks.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

namespace topple::viewer {

glm::vec3 drawn_axis(const MemberInstance& m, float s) {
  const glm::vec3 x = glm::quat(m.rotation.w, m.rotation.x, m.rotation.y, m.rotation.z) * glm::vec3(1, 0, 0);
  const float rest = 1 - s;
  const glm::vec3 way = m.displacement2 - m.displacement1, along = x * glm::dot(way, x), across = way - along;
  const glm::vec3 slopes = s * rest * rest * glm::cross(m.rotation1, x) - s * s * rest * glm::cross(m.rotation2, x);
  return m.first_end + s * m.length * x + m.displacement1 + s * along + s * s * (3 - 2 * s) * across +
         m.length * slopes + 16 * s * s * rest * rest * m.bulge;
}

RigidInstance hinge_mark(const MemberInstance& member, const structure::Section& section, int end, double share,
                         Rgba colour) {
  const double given = std::max(section.depth, section.width), side = given > 0 ? given : std::sqrt(section.area);
  constexpr double farthest = 0.2;  // of the length
  const auto away = static_cast<float>(std::min(side / static_cast<double>(member.length), farthest));
  const auto radius = static_cast<float>(0.6 * side * (1 + std::clamp(share, 0.0, 1.0)));
  return {drawn_axis(member, end == 0 ? away : 1 - away), {0, 0, 0, 1}, glm::vec3(radius), colour};
}

}  // namespace topple::viewer
