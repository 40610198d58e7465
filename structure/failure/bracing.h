#pragma once
// The classic rule of bracing: a post joint snaps when all beam joints that brace it are gone. A post's joint is braced
// by the joints of beams and braces at its own node; one whose node never had any is not in the table.
#include <vector>

#include "topple/structure/building.h"

namespace topple::structure {

class ClassicBracing {
 public:
  explicit ClassicBracing(const Building& building);
  /// Tells that a member's joint no longer holds; once for each joint. Returns the post joints that have nothing left
  /// to brace them, in order of id (among them perhaps ones that are broken already).
  [[nodiscard]] const std::vector<JointId>& lose(JointId joint);

  template <class Archive>
  void serialize(Archive& archive) {
    auto& [bracing_node, left, braced, none] = *this;
    archive(bracing_node, left);  // posts at nodes follow from the building, and `none` stays empty
  }

 private:
  std::vector<int> bracing_node_;             ///< per member joint: node that it braces, -1: none
  std::vector<int> left_;                     ///< per node: bracing joints that hold
  std::vector<std::vector<JointId>> braced_;  ///< per node: breakable post joints
  std::vector<JointId> none_;
};

}  // namespace topple::structure
