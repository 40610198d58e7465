#pragma once
// Torn ends of members of concrete that have come off.
#include <array>
#include <vector>

#include "renderer/instances/part_instances.h"

namespace topple::viewer {

class TornEndInstances {
 public:
  /// The building must outlive it.
  explicit TornEndInstances(const structure::Building& building);

  /// These members have come off. A member was torn from all that was at its end where its own joint failed, or where
  /// nothing else of its body hangs.
  void find(const std::vector<MovingPart>& members, const FrameAnswer& answer);
  /// Of the same members, where their bodies are now.
  void update(const std::vector<MovingPart>& members, const PartInstances& parts, const Snapshot& snapshot,
              const ViewOptions& options);
  /// Variants of each section, in their order.
  [[nodiscard]] const std::vector<InstanceBatch<RigidInstance>>& batches() const { return batches_; }

 private:
  void add(std::size_t member, int end, const MemberInstance& instance, const glm::vec3& rest);

  const structure::Building& building_;
  std::vector<InstanceBatch<RigidInstance>> batches_;
  std::vector<std::array<bool, 2>> torn_;  ///< of each member: ends at which nothing of the same body holds
};

}  // namespace topple::viewer
