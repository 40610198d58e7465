#pragma once
// Loads of a standing frame, kept by what brings them: a part's own, what panels hand on, what tools add, what lies on
// it. Changes collect until they are taken; then only members and nodes whose loads changed are written anew.
#include <map>
#include <vector>

#include "failure/panel_bearings.h"
#include "model/index_of.h"
#include "standing/panel_superelements.h"
#include "topple/structure/standing_frame.h"

namespace topple::structure {

/// Loads on members (local axes; BeamLoad::beam unused) and nodes that one force on the frame makes.
struct PlacedLoad {
  std::vector<std::pair<MemberId, solver::BeamLoad>> members;
  std::vector<std::pair<NodeId, Vec6>> nodes;
  /// On a panel: force that it hands to each edge (global), and how far its own bending gives way along a unit force.
  PanelId panel;
  std::array<Vec3, 4> edge_force{Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
  double bending_compliance = 0;
  PanelForce on_shell;  ///< the force itself, where the panel is a shell
};

template <class Archive>
void serialize(Archive& archive, PlacedLoad& placed) {
  auto& [members, nodes, panel, edge_force, bending_compliance, on_shell] = placed;
  archive(members, nodes, panel, edge_force, bending_compliance, on_shell);
}

/// Both put the same on the same parts.
[[nodiscard]] bool same_load(const PlacedLoad& a, const PlacedLoad& b);

class FrameLoads {
 public:
  /// `bearings` and `shells` must outlive this.
  FrameLoads(const Building& building, PartLoads loads, const PanelBearings& bearings,
             const PanelSuperelements& shells);

  // Masses in the combination: downward load over gravity.
  [[nodiscard]] double mass(MemberId member) const { return member_mass_[index_of(member)]; }
  [[nodiscard]] double mass(PanelId panel) const { return panel_mass_[index_of(panel)]; }
  [[nodiscard]] double mass(NodeId node) const { return node_mass_[index_of(node)]; }

  void set_gravity(const Vec3& gravity);
  void add_load(NodeId node, const Vec6& load);
  /// The panel's bearings changed, or it left.
  void hand_on_anew(PanelId panel);
  /// A shell panel left: it brings no load any more.
  void remove(PanelId shell);
  /// What acts on all of a shell panel, contacts apart.
  [[nodiscard]] Vec3 traction(PanelId panel) const;
  /// Only this remains of a panel that stands.
  void fracture(PanelId panel, const PanelRemains& remains);
  /// Returns false when nothing changes.
  bool set_contact(std::int64_t key, PlacedLoad load);
  bool remove_contact(std::int64_t key);

  /// Members and nodes whose loads changed since the last call, in order of id.
  struct Changed {
    std::vector<MemberId> members;
    std::vector<NodeId> nodes;
    [[nodiscard]] bool none() const { return members.empty() && nodes.empty(); }
  };
  [[nodiscard]] Changed extract_changed();
  [[nodiscard]] bool changed() const { return !changed_members_.empty() || !changed_nodes_.empty(); }

  /// All that is on a member or node now.
  [[nodiscard]] std::vector<solver::BeamLoad> on(MemberId member) const;
  [[nodiscard]] Vec6 on(NodeId node) const;
  /// The part of it that counts as mass or comes from the combination; the rest is contact and event loads.
  [[nodiscard]] std::vector<solver::BeamLoad> own_and_handed(MemberId member) const;
  [[nodiscard]] Vec6 own_and_handed(NodeId node) const;
  /// What is the part's own: neither handed on by panels nor added by events or contacts.
  [[nodiscard]] std::vector<solver::BeamLoad> own(MemberId member) const;
  [[nodiscard]] Vec6 own(NodeId node) const { return under_gravity(loads_.nodes[index_of(node)]); }
  [[nodiscard]] const TributaryLoads& handed(PanelId panel) const { return handed_[index_of(panel)]; }
  [[nodiscard]] const Vec6& event_load(NodeId node) const { return events_[index_of(node)]; }
  [[nodiscard]] const std::map<std::int64_t, PlacedLoad>& contacts() const { return contacts_; }
  /// Force that a panel hands to one of its edges, contacts on it included, global axes.
  [[nodiscard]] Vec3 edge_force(PanelId panel, int edge) const;
  /// Another number whenever what the panel hands to its edges, or the edges that bear it, may have changed.
  [[nodiscard]] int edges_version(PanelId panel) const { return edges_version_[index_of(panel)]; }

  template <class Archive>
  void serialize(Archive& archive) {
    auto& [building, loads, bearings, shells, shell_gone, usual_gravity, gravity, handed, handing_members,
           handing_nodes, events, contacts, holes, whole_panel_mass, member_mass, panel_mass, node_mass, edges_version,
           changed_members, changed_nodes] = *this;
    // The combination's loads, and masses of what is whole, follow from the building.
    archive(shell_gone, usual_gravity, gravity, handed, handing_members, handing_nodes, events, contacts, holes,
            panel_mass, edges_version, changed_members, changed_nodes);
  }

 private:
  [[nodiscard]] solver::BeamLoad under_gravity(MemberId member, solver::BeamLoad load) const;
  [[nodiscard]] Vec6 under_gravity(const Vec6& load) const;
  [[nodiscard]] PanelAction under_gravity(PanelId panel, PanelAction action) const;
  void hand_on_shell(PanelId panel);
  void mark(const TributaryLoads& handed);
  void mark(const PlacedLoad& placed);

  const Building& building_;
  PartLoads loads_;
  const PanelBearings& bearings_;
  const PanelSuperelements& shells_;
  std::vector<char> shell_gone_;  ///< per panel
  bool usual_gravity_ = true;
  Vec3 gravity_;
  std::vector<TributaryLoads> handed_;                             ///< per panel
  std::vector<std::vector<int>> handing_members_, handing_nodes_;  ///< per member, node: panels that hand it something
  std::vector<Vec6> events_;
  std::map<std::int64_t, PlacedLoad> contacts_;
  std::map<PanelId, std::vector<std::vector<Vec2>>> holes_;  ///< of broken panels
  std::vector<double> whole_panel_mass_;
  std::vector<double> member_mass_, panel_mass_, node_mass_;
  std::vector<int> edges_version_;
  std::vector<MemberId> changed_members_;
  std::vector<NodeId> changed_nodes_;
};

}  // namespace topple::structure
