#pragma once
// What membrane and cladding panels lie on, and when they give up: an edge joint is a one-way support by the members
// along that edge (by its two nodes where there are none); losing the member breaks it. Membrane stiffness is there
// while all four hold; after the first loss a panel is load alone between an opposite pair, and without a pair it
// leaves.
#include <array>
#include <optional>
#include <vector>

#include "model/index_of.h"
#include "topple/structure/frame.h"

namespace topple::structure {

class PanelBearings {
 public:
  PanelBearings(const Building& building, const EdgeMembers& edges);

  /// What happened to panels in one change, in order of id.
  struct Changes {
    std::vector<PanelId> lost_edge;                    ///< still stand; their load goes another way now
    std::vector<PanelId> lost_membrane;                ///< no stiffness from now on
    std::vector<PanelId> fell;                         ///< without an opposite pair: each leaves alone
    std::vector<std::pair<PanelId, int>> carried_off;  ///< left with the part of that number that bears them
  };
  /// One edge joint breaks. No effect on one that is broken already.
  Changes break_edge(PanelId panel, int edge);
  /// A panel is broken in part: it lies on this length of each edge at most.
  void fracture(PanelId panel, const std::array<double, 4>& edge_length);
  /// A panel is taken away; its edge joints are gone.
  void remove(PanelId panel);
  /// Members and nodes that no longer stand, with the part (0 and up) that they left in, or -1: taken away.
  struct Left {
    std::vector<std::pair<MemberId, int>> members;
    std::vector<std::pair<NodeId, int>> nodes;
  };
  Changes leave(const Left& left);
  /// Takes over the state of another one of the same building.
  void become(const PanelBearings& other);
  /// A node that stands, but with no member on it: a membrane can no longer hang there.
  Changes bare(NodeId node);

  [[nodiscard]] bool tracks(PanelId panel) const { return state(panel).tracked; }
  [[nodiscard]] bool stands(PanelId panel) const { return state(panel).stands; }
  [[nodiscard]] bool membrane(PanelId panel) const { return state(panel).membrane; }
  [[nodiscard]] const std::array<bool, 4>& holds(PanelId panel) const { return state(panel).holds; }
  /// Standing members along an edge, and their length; the whole edge where it never had members.
  [[nodiscard]] double intact_length(PanelId panel, int edge) const;
  /// The first standing member (else node) that bears the panel; what its segment is.
  [[nodiscard]] std::optional<MemberId> bearing_member(PanelId panel) const;
  [[nodiscard]] NodeId bearing_node(PanelId panel) const;
  [[nodiscard]] const std::vector<bool>& member_stands() const { return member_stands_; }
  [[nodiscard]] const EdgeMembers& edge_members() const { return edges_; }
  /// Panels of which the member bears an edge.
  [[nodiscard]] const std::vector<PanelId>& on(MemberId member) const { return panels_on_member_[index_of(member)]; }

  template <class Archive>
  void serialize(Archive& archive) {
    auto& [building, edges, states, panels_on_member, panels_at_node, member_stands, member_part, node_part] = *this;
    // Which panels lie on what follows from the building.
    archive(states, member_stands, member_part, node_part);
  }

 private:
  struct State {
    bool tracked = false, stands = false, membrane = false;
    std::array<bool, 4> holds{};
    std::array<double, 4> edge_length{unlimited, unlimited, unlimited, unlimited};
  };
  template <class Archive>
  friend void serialize(Archive& archive, State& of_panel) {
    auto& [tracked, stands, membrane, holds, edge_length] = of_panel;
    archive(tracked, stands, membrane, holds, edge_length);
  }
  [[nodiscard]] const State& state(PanelId panel) const { return states_[index_of(panel)]; }
  State& state(PanelId panel) { return states_[index_of(panel)]; }
  /// -1: stands; 0 and up: left in that part; -2: gone.
  [[nodiscard]] int bearer(PanelId panel, int edge) const;
  void settle(PanelId panel, Changes& changes);
  void lose_membrane(PanelId panel, Changes& changes);

  const Building& building_;
  const EdgeMembers& edges_;
  std::vector<State> states_;
  std::vector<std::vector<PanelId>> panels_on_member_, panels_at_node_;
  std::vector<bool> member_stands_;
  std::vector<int> member_part_, node_part_;  ///< -1 stands, else as `bearer`
};

}  // namespace topple::structure
