#pragma once
// What of a standing frame its solver holds: the nodes that it has not dropped, and the loads that it was given last.
// Nothing else drops nodes of the statics or writes loads to them.
#include <vector>

#include "model/index_of.h"
#include "standing/statics/frame_statics.h"

namespace topple::structure {

class SolverContents {
 public:
  /// All nodes, and no loads. `statics` must outlive it.
  SolverContents(const Building& building, FrameStatics& statics)
      : statics_(statics),
        holds_(building.nodes.size(), 1),
        nodes_of_(static_cast<std::size_t>(statics.components()), 0),
        member_loads_(building.members.size()),
        node_loads_(building.nodes.size(), Vec6::Zero()) {
    for (std::size_t n = 0; n < building.nodes.size(); ++n)
      ++nodes_of_[static_cast<std::size_t>(statics.component(NodeId(n)))];
  }

  [[nodiscard]] bool holds(NodeId node) const { return holds_[index_of(node)] != 0; }
  /// How many nodes of the component it holds.
  [[nodiscard]] int nodes_of(int component) const { return nodes_of_[static_cast<std::size_t>(component)]; }
  /// In the member's axes.
  [[nodiscard]] const std::vector<solver::BeamLoad>& loads(MemberId member) const {
    return member_loads_[index_of(member)];
  }
  /// N and N m, global axes.
  [[nodiscard]] const Vec6& load(NodeId node) const { return node_loads_[index_of(node)]; }

  /// A node that it holds: the solver has no stiffness for it any more.
  void drop(NodeId node) {
    holds_[index_of(node)] = 0;
    --nodes_of_[static_cast<std::size_t>(statics_.component(node))];
    statics_.drop({node});
  }
  void write(MemberId member, std::vector<solver::BeamLoad> loads) {
    member_loads_[index_of(member)] = std::move(loads);
    statics_.set_loads(member, member_loads_[index_of(member)]);
  }
  void write(NodeId node, const Vec6& load) {
    node_loads_[index_of(node)] = load;
    statics_.set_load(node, load);
  }

  // By index of node and member, for parts that look at all of them.
  [[nodiscard]] const std::vector<char>& held_nodes() const { return holds_; }
  [[nodiscard]] const std::vector<std::vector<solver::BeamLoad>>& member_loads() const { return member_loads_; }
  [[nodiscard]] const std::vector<Vec6>& node_loads() const { return node_loads_; }

  template <class Archive>
  void serialize(Archive& archive) {
    auto& [statics, holds, nodes_of, member_loads, node_loads] = *this;
    archive(holds, nodes_of, member_loads, node_loads);
  }

 private:
  FrameStatics& statics_;
  std::vector<char> holds_;    ///< per node
  std::vector<int> nodes_of_;  ///< per component
  std::vector<std::vector<solver::BeamLoad>> member_loads_;
  std::vector<Vec6> node_loads_;
};

}  // namespace topple::structure
