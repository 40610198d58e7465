#pragma once
// Which connected component of the undamaged building (by members, panels and diaphragms) each part belongs to, and its
// number in that component's frame.
#include <utility>
#include <vector>

#include "model/index_of.h"
#include "topple/structure/frame.h"

namespace topple::structure {

class FrameNumbers {
 public:
  /// In the building's ids.
  struct ResponseLoads {
    std::vector<std::pair<MemberId, solver::BeamLoad>> members;
    std::vector<std::pair<NodeId, Vec6>> nodes;
  };

  /// Divides the frame; `models` gets a frame for each component.
  FrameNumbers(const Building& building, const Frame& frame, std::vector<solver::FrameModel>& models);

  [[nodiscard]] int components() const { return static_cast<int>(parts_.size()); }
  [[nodiscard]] int component(NodeId node) const { return node_place_[index(node)].component; }
  [[nodiscard]] int component(MemberId member) const { return member_place_[index(member)].component; }
  /// Index in the component's frame.
  [[nodiscard]] int number(NodeId node) const { return node_place_[index(node)].local; }
  [[nodiscard]] int number(MemberId member) const { return member_place_[index(member)].local; }
  /// Among the supports of its component's frame; `support` in the order of the building's.
  [[nodiscard]] int support_number(std::size_t support) const { return support_place_[support].local; }
  /// Among its membranes, or its patches.
  [[nodiscard]] int number(PanelId panel) const { return panel_place_[index(panel)].local; }

  [[nodiscard]] const std::vector<NodeId>& nodes(int component) const { return of(component).nodes; }
  [[nodiscard]] const std::vector<MemberId>& members(int component) const { return of(component).members; }
  [[nodiscard]] const std::vector<PanelId>& membranes(int component) const { return of(component).membranes; }
  [[nodiscard]] const std::vector<PanelId>& shells(int component) const { return of(component).shells; }
  /// Both, membranes first.
  [[nodiscard]] std::vector<PanelId> plates(int component) const {
    std::vector<PanelId> all = membranes(component);
    all.insert(all.end(), shells(component).begin(), shells(component).end());
    return all;
  }

 protected:
  struct Place {
    int component = -1, local = -1;
  };
  template <class Tag>
  static std::size_t index(Id<Tag> id) {
    return index_of(id);
  }
  /// A panel is a patch of its component's frame: one element with a stiffness that is given.
  [[nodiscard]] bool is_patch(PanelId panel) const { return patch_[index(panel)] != 0; }
  /// In the numbers of the component.
  [[nodiscard]] solver::LoadSet local(const ResponseLoads& loads) const;

  std::vector<Place> node_place_, member_place_, panel_place_, support_place_;
  std::vector<NodeId> support_node_;
  std::vector<int> support_edge_;  ///< per support: index in Building::edge_supports, -1: of a node

 private:
  struct Parts {
    std::vector<NodeId> nodes;
    std::vector<MemberId> members;
    std::vector<PanelId> membranes, shells;  ///< shells and patches of the model, in order
  };
  [[nodiscard]] const Parts& of(int component) const { return parts_[static_cast<std::size_t>(component)]; }
  void number_panels(const Building& building, const Frame& frame, std::vector<solver::FrameModel>& models);
  void number_supports(const Building& building, const Frame& frame, std::vector<solver::FrameModel>& models);

  std::vector<Parts> parts_;  ///< per component
  std::vector<char> patch_;   ///< per panel
};

}  // namespace topple::structure
