#pragma once
// A model that is drawn around the building: a batch for each piece, bent while it stands.
#include <map>
#include <memory>
#include <vector>

#include "renderer/instances/instance_parts.h"

namespace topple::viewer {

class DrawnInstances {
 public:
  /// Places are relative to `origin`. The building must outlive it.
  DrawnInstances(const structure::Building& building, const glm::dvec3& origin)
      : building_(building), origin_(origin) {}

  /// `bend`: what stands is bent otherwise than before.
  void update(const Snapshot& snapshot, const ViewOptions& options, bool bend);
  /// Batches are only ever added. One that is gone has no instance.
  [[nodiscard]] const std::vector<InstanceBatch<RigidInstance>>& batches() const { return batches_; }

 private:
  struct Own {
    std::size_t batch = 0;
    bool bent = false;
  };
  void bend(const DrawnPiece& piece, const Snapshot& snapshot, const ViewOptions& options,
            InstanceBatch<RigidInstance>& batch) const;

  const structure::Building& building_;
  glm::dvec3 origin_;
  std::vector<InstanceBatch<RigidInstance>> batches_;
  std::map<std::shared_ptr<const fracture::Mesh>, Own> of_mesh_;
};

}  // namespace topple::viewer
