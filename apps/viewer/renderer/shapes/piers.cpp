#include "renderer/shapes/piers.h"

#include <algorithm>
#include <cmath>

namespace topple::viewer {
namespace {

using structure::Building;
using structure::Section;

/// Lower ones would not be seen, m.
constexpr double least_height = 0.3;
/// The least width, m; of tall ones by their height, as far as a pillar of a bridge is slender; beside what lies on it.
constexpr double least_width = 0.3, least_slenderness = 1.0 / 16, overhang = 1.2;
/// A member goes down where the downward part of its direction is at least this: steeper than 45 degrees.
constexpr double steep = 0.7;

/// What lies on a node.
struct Bearing {
  double depth = 0, width = 0;  ///< m, the largest of members that lie there
  bool carried = false;         ///< a member goes down from it
};

std::vector<Bearing> bearings_of(const Building& building) {
  std::vector<Bearing> bearings(building.nodes.size());
  for (const structure::Member& member : building.members) {
    const Section& section = building[member.section];
    const double square = std::sqrt(section.area);
    const double depth = section.depth > 0 ? section.depth : square, width = section.width > 0 ? section.width : square;
    const structure::Vec3 way = building[member.nodes[1]].position - building[member.nodes[0]].position;
    const double rise = way.norm() > 0 ? way.z() / way.norm() : 0;
    for (std::size_t end = 0; end < 2; ++end) {
      Bearing& bearing = bearings[static_cast<std::size_t>(member.nodes[end].index)];
      if ((end == 0 ? -rise : rise) > steep) bearing.carried = true;
      bearing.width = std::max({bearing.width, width, std::abs(rise) > steep ? depth : 0});
      if (std::abs(rise) < steep) bearing.depth = std::max(bearing.depth, depth);
    }
  }
  return bearings;
}

}  // namespace

std::vector<Pier> piers_of(const Building& building, double ground) {
  const std::vector<Bearing> bearings = bearings_of(building);
  std::vector<Pier> piers;
  for (std::size_t s = 0; s < building.supports.size(); ++s) {
    const structure::NodeSupport& support = building.supports[s];
    const Bearing& bearing = bearings[static_cast<std::size_t>(support.node.index)];
    const structure::Vec3& at = building[support.node].position;
    const double height = at.z() - bearing.depth / 2 - ground;
    if (!(support.stiffness[2] > 0) || bearing.carried || height < least_height) continue;
    const double width = std::max({least_width, overhang * bearing.width, least_slenderness * height});
    piers.push_back({s, {at.x(), at.y(), ground}, width, height});
  }
  return piers;
}

Mesh pier_mesh() {
  Mesh mesh;
  const auto face = [&mesh](const glm::vec3& normal, const glm::vec3& across) {
    const glm::vec3 middle(0.5F * normal.x, 0.5F * normal.y, 0.5F + 0.5F * normal.z);
    const glm::vec3 up(normal.y * across.z - normal.z * across.y, normal.z * across.x - normal.x * across.z,
                       normal.x * across.y - normal.y * across.x);
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const auto& [x, y] :
         {std::pair(-0.5F, -0.5F), std::pair(0.5F, -0.5F), std::pair(0.5F, 0.5F), std::pair(-0.5F, 0.5F)})
      mesh.vertices.push_back({middle + x * across + y * up, normal});
    for (const std::uint32_t corner : {0U, 1U, 2U, 0U, 2U, 3U}) mesh.indices.push_back(first + corner);
  };
  face({1, 0, 0}, {0, 1, 0});
  face({-1, 0, 0}, {0, -1, 0});
  face({0, 1, 0}, {-1, 0, 0});
  face({0, -1, 0}, {1, 0, 0});
  face({0, 0, 1}, {1, 0, 0});
  face({0, 0, -1}, {-1, 0, 0});
  return mesh;
}

}  // namespace topple::viewer
