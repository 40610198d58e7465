#pragma once
// What lies under the pointer: the nearest drawn part along a ray, as it stands or lies in a snapshot.
#include <optional>

#include "renderer/camera.h"
#include "renderer/snapshot.h"
#include "renderer/view_options.h"
#include "topple/structure/building.h"

namespace topple::viewer {

struct Pick {
  structure::MemberId member;  ///< valid, or the panel is; neither: the ground
  structure::PanelId panel;
  structure::JointId joint;  ///< the member's nearer end, or the panel's nearest edge
  glm::dvec3 point{0};
  double distance = 0;
};

/// Members as boxes of their depth and width, panels as their middle surface without openings; what `options` hides is
/// passed through. `ground`: its height.
[[nodiscard]] std::optional<Pick> pick(const structure::Building& building, const Snapshot& snapshot,
                                       const ViewOptions& options, double ground, const Ray& ray);

}  // namespace topple::viewer
