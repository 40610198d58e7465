#include "renderer/instances/drawn_instances.h"

#include <algorithm>

#include "renderer/shapes/looks.h"
#include "topple/structure/visual_mesh.h"

namespace topple::viewer {

/// Its vertices follow the parts that they hang on, as these are drawn.
void DrawnInstances::bend(const DrawnPiece& piece, const Snapshot& snapshot, const ViewOptions& options,
                          InstanceBatch<RigidInstance>& batch) const {
  const DrawnShape shape(snapshot, options);
  const structure::BentBuilding bent{
      [&](structure::NodeId node) -> structure::Vec6 { return shape.at(node).cast<double>(); },
      [&](structure::JointId joint) { return snapshot.answer->joints[static_cast<std::size_t>(joint.index)].intact; }};
  for (std::size_t v = 0; v < piece.mesh->positions.size(); ++v) {
    const Eigen::Vector3d& at = piece.mesh->positions[v];
    const Eigen::Vector3f now =
        (at + structure::displacement_with(building_, (*piece.bones)[v], at, bent)).cast<float>();
    batch.mesh.vertices[v].position = {now.x(), now.y(), now.z()};
  }
  ++batch.mesh_revision;
}

void DrawnInstances::update(const Snapshot& snapshot, const ViewOptions& options, bool bend_anew) {
  for (auto& batch : batches_) batch.instances.clear();
  if (!snapshot.drawn || !options.drawn) return;
  for (const DrawnPiece& piece : *snapshot.drawn) {
    const auto body = std::lower_bound(snapshot.bodies.begin(), snapshot.bodies.end(), piece.body,
                                       [](const BodyPose& pose, std::int64_t id) { return pose.id < id; });
    const bool stands = piece.body == part_stands;
    if (!stands && (!options.debris || body == snapshot.bodies.end() || body->id != piece.body)) continue;
    const auto [found, is_new] = of_mesh_.try_emplace(piece.mesh, Own{batches_.size(), false});
    if (is_new) {
      batches_.emplace_back();
      batches_.back().mesh = chunk_mesh(*piece.mesh);
    }
    Own& own = found->second;
    InstanceBatch<RigidInstance>& batch = batches_[own.batch];
    if (stands && piece.bones && (bend_anew || !own.bent)) {
      bend(piece, snapshot, options, batch);
      own.bent = true;
    } else if (!stands && own.bent) {
      batch.mesh = chunk_mesh(*piece.mesh);
      ++batch.mesh_revision;
      own.bent = false;
    }
    glm::dvec3 position(0);
    glm::dquat turn(1, 0, 0, 0);
    if (!stands) {
      const BodyMotion motion(*body);
      position = motion(glm::dvec3(0));
      turn = motion.turn;
    }
    const Rgba colour = options.colouring == Colouring::materials ? look_colour(Look::plaster) : drawn_colour;
    batch.instances.push_back({glm::vec3(position - origin_), packed(turn), glm::vec3(1), colour, glm::vec3(-origin_)});
  }
}

}  // namespace topple::viewer
