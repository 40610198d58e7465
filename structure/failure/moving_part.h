#pragma once
// Which part of an anchored segment moves when the analysis finds a mechanism, and what still holds it.
#include <vector>

#include "failure/segmentation.h"
#include "standing/statics/frame_statics.h"

namespace topple::structure {

struct MovingPart {
  std::vector<NodeId> nodes;
  std::vector<MemberId> members;
  std::vector<JointId> holds;  ///< joints between what moves and what does not, in order of id
};

/// A node moves when its motion passes `moving_limit` of the largest; a member moves when a joint that holds it hands
/// on such a motion (a released component does not). Never empty: at least the node that moves most, with its members.
[[nodiscard]] MovingPart find_moving_part(const Building& building, const Segmentation& segments,
                                          const FrameMechanism& mechanism);

/// True when the member's holding joints leave it free to move by itself: one end broken and any component released at
/// the other. The solver has no equation for such a motion, since a beam's own freedoms are condensed.
[[nodiscard]] bool hangs_loose(const Building& building, const Segmentation& segments, MemberId member);

}  // namespace topple::structure
