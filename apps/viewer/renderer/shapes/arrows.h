#pragma once
// Loads, reactions and contacts as arrows in the scene.
#include "renderer/instances/instance_batch.h"
#include "renderer/snapshot.h"
#include "renderer/view_options.h"

namespace topple::viewer {

/// Largest of each kind, in N (spread loads N/m): the legend tells what the longest arrow means.
struct ArrowScale {
  double spread = 0, points = 0, contacts = 0, reactions = 0;
};
[[nodiscard]] ArrowScale arrow_scale(const FrameForces& forces);

/// Instances of arrow_mesh(). The largest arrow of each kind is `longest` long, of spread loads half of that. Each ends
/// at the place where it acts.
[[nodiscard]] std::vector<RigidInstance> arrow_instances(const FrameForces& forces, const ViewOptions& options,
                                                         const glm::dvec3& origin, float longest);

[[nodiscard]] std::vector<RigidInstance> reaction_instances(const FrameForces& forces, const glm::dvec3& origin,
                                                            float longest);

}  // namespace topple::viewer
