#pragma once
// What is left of panels that broke: chunks, and what remains of each panel. Each chunk, and each state of what
// remains, has a mesh of its own; batches are only ever added. One that is gone has no instance.
#include <array>
#include <map>
#include <memory>
#include <vector>

#include "renderer/instances/instance_parts.h"

namespace topple::viewer {

class ChunkInstances {
 public:
  /// Places are relative to `origin`. The building must outlive it.
  ChunkInstances(const structure::Building& building, const glm::dvec3& origin)
      : building_(building), origin_(origin) {}

  /// `bend`: what stands is bent otherwise than before.
  void update(const Snapshot& snapshot, const ViewOptions& options, bool bend);
  [[nodiscard]] const std::vector<InstanceBatch<RigidInstance>>& batches() const { return batches_; }

 private:
  /// Of a panel that is broken in part: the mesh that it draws, where its vertices are while nothing bends it, and how
  /// its corners have moved as it is drawn.
  struct BrokenPanel {
    std::shared_ptr<const fracture::Mesh> mesh;
    std::size_t batch = 0;
    std::vector<glm::vec3> rest;
    std::array<Eigen::Vector3f, 4> moved{};
  };
  void update_chunks(const Snapshot& snapshot, const ViewOptions& options);
  void update_broken_panels(const Snapshot& snapshot, const ViewOptions& options, bool bend);
  void bend_broken_panel(std::size_t panel, const Snapshot& snapshot, const ViewOptions& options, BrokenPanel& drawn);
  [[nodiscard]] std::size_t bars_of_chunk(structure::MaterialId material) const;

  const structure::Building& building_;
  glm::dvec3 origin_;
  std::vector<InstanceBatch<RigidInstance>> batches_;
  std::map<std::int64_t, std::size_t> batch_of_body_;
  std::map<std::size_t, BrokenPanel> broken_panels_;
};

}  // namespace topple::viewer
