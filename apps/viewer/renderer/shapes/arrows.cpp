#include "renderer/shapes/arrows.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace topple::viewer {
namespace {

using Arrows = std::vector<FrameForces::Arrow>;

double largest(const Arrows& arrows) {
  float most = 0;
  for (const auto& arrow : arrows) most = std::max(most, arrow.force.norm());
  return most;
}

/// Shorter than this share of the longest, an arrow is left out.
constexpr float shortest = 0.02F;

void add(std::vector<RigidInstance>& instances, const Arrows& arrows, const glm::dvec3& origin, float longest,
         Rgba colour) {
  const auto most = static_cast<float>(largest(arrows));
  for (const auto& arrow : arrows) {
    const float size = arrow.force.norm();
    if (!(size > shortest * most)) continue;
    const float length = longest * size / most;
    const Eigen::Vector3f along = arrow.force / size;
    const auto turn = Eigen::Quaternionf::FromTwoVectors(Eigen::Vector3f::UnitZ(), along);
    const glm::vec3 head(glm::dvec3(arrow.at.x(), arrow.at.y(), arrow.at.z()) - origin);
    const float width = std::clamp(length, 0.5F * longest, longest);
    instances.push_back({head - length * glm::vec3(along.x(), along.y(), along.z()),
                         {turn.x(), turn.y(), turn.z(), turn.w()},
                         {width, width, length},
                         colour});
  }
}

}  // namespace

ArrowScale arrow_scale(const FrameForces& forces) {
  return {largest(forces.spread), largest(forces.points), largest(forces.contacts), largest(forces.reactions)};
}

std::vector<RigidInstance> arrow_instances(const FrameForces& forces, const ViewOptions& options,
                                           const glm::dvec3& origin, float longest) {
  std::vector<RigidInstance> instances;
  if (options.loads) {
    add(instances, forces.spread, origin, 0.5F * longest, load_colour);
    add(instances, forces.points, origin, longest, load_colour);
  }
  if (options.contacts) add(instances, forces.contacts, origin, longest, contact_colour);
  return instances;
}

std::vector<RigidInstance> reaction_instances(const FrameForces& forces, const glm::dvec3& origin, float longest) {
  std::vector<RigidInstance> instances;
  add(instances, forces.reactions, origin, longest, reaction_colour);
  return instances;
}

}  // namespace topple::viewer
