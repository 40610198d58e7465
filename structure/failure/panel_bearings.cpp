#include "failure/panel_bearings.h"

#include <algorithm>

#include "model/index_of.h"

namespace topple::structure {

namespace {

constexpr int standing = -1, gone = -2;

void sort_unique(std::vector<PanelId>& panels) {
  std::sort(panels.begin(), panels.end());
  panels.erase(std::unique(panels.begin(), panels.end()), panels.end());
}

}  // namespace

PanelBearings::PanelBearings(const Building& building, const EdgeMembers& edges)
    : building_(building),
      edges_(edges),
      states_(building.panels.size()),
      panels_on_member_(building.members.size()),
      panels_at_node_(building.nodes.size()),
      member_stands_(building.members.size(), true),
      member_part_(building.members.size(), standing),
      node_part_(building.nodes.size(), standing) {
  for (std::size_t p = 0; p < building.panels.size(); ++p) {
    const Panel& panel = building.panels[p];
    const PanelId id(p);
    State& own = states_[p];
    own.tracked = panel.model != PanelModel::shell;
    own.stands = true;
    own.holds.fill(true);
    own.membrane = panel.model == PanelModel::membrane;
    if (!own.tracked) continue;
    for (NodeId node : panel.nodes) panels_at_node_[index_of(node)].push_back(id);
    for (int edge = 0; edge < 4; ++edge)
      for (MemberId member : edges_.of(id, edge)) panels_on_member_[index_of(member)].push_back(id);
  }
  for (auto& panels : panels_on_member_) sort_unique(panels);
  for (auto& panels : panels_at_node_) sort_unique(panels);
}

int PanelBearings::bearer(PanelId panel, int edge) const {
  const std::vector<MemberId>& members = edges_.of(panel, edge);
  int part = gone;
  for (MemberId member : members) {
    const int where = member_part_[index_of(member)];
    if (where == standing) return standing;
    if (part == gone) part = where;
  }
  if (!members.empty()) return part;
  const Panel& own = building_[panel];
  const int first = node_part_[index_of(own.nodes[static_cast<std::size_t>(edge)])];
  const int second = node_part_[index_of(own.nodes[static_cast<std::size_t>((edge + 1) % 4)])];
  return first == second ? first : gone;
}

PanelBearings::Changes PanelBearings::break_edge(PanelId panel, int edge) {
  Changes changes;
  State& own = state(panel);
  bool& holds = own.holds[static_cast<std::size_t>(edge)];
  if (!own.tracked || !own.stands || !holds) return changes;
  holds = false;
  changes.lost_edge.push_back(panel);
  settle(panel, changes);
  return changes;
}

void PanelBearings::fracture(PanelId panel, const std::array<double, 4>& edge_length) {
  state(panel).edge_length = edge_length;
}

void PanelBearings::remove(PanelId panel) {
  State& own = state(panel);
  own.stands = own.membrane = false;
  own.holds.fill(false);
}

PanelBearings::Changes PanelBearings::leave(const Left& left) {
  std::vector<PanelId> touched;
  for (const auto& [member, part] : left.members) {
    member_part_[index_of(member)] = part < 0 ? gone : part;
    member_stands_[index_of(member)] = false;
    const auto& panels = panels_on_member_[index_of(member)];
    touched.insert(touched.end(), panels.begin(), panels.end());
  }
  for (const auto& [node, part] : left.nodes) {
    node_part_[index_of(node)] = part < 0 ? gone : part;
    const auto& panels = panels_at_node_[index_of(node)];
    touched.insert(touched.end(), panels.begin(), panels.end());
  }
  sort_unique(touched);
  Changes changes;
  for (PanelId panel : touched) {
    State& own = state(panel);
    if (!own.stands) continue;
    // The load finds another way also when an edge keeps some of its members.
    changes.lost_edge.push_back(panel);
    const bool corner_left = std::any_of(building_[panel].nodes.begin(), building_[panel].nodes.end(),
                                         [&](NodeId node) { return node_part_[index_of(node)] != standing; });
    if (corner_left) lose_membrane(panel, changes);
    settle(panel, changes);
  }
  // Parts are numbered anew with the next departure.
  for (const auto& [member, part] : left.members) member_part_[index_of(member)] = gone;
  for (const auto& [node, part] : left.nodes) node_part_[index_of(node)] = gone;
  return changes;
}

void PanelBearings::become(const PanelBearings& other) {
  states_ = other.states_;
  member_stands_ = other.member_stands_;
  member_part_ = other.member_part_;
  node_part_ = other.node_part_;
}

PanelBearings::Changes PanelBearings::bare(NodeId node) {
  Changes changes;
  for (PanelId panel : panels_at_node_[index_of(node)])
    if (state(panel).stands) lose_membrane(panel, changes);
  return changes;
}

void PanelBearings::lose_membrane(PanelId panel, Changes& changes) {
  State& own = state(panel);
  if (own.membrane) changes.lost_membrane.push_back(panel);
  own.membrane = false;
}

/// Decides what bears the panel now: what stands if it has an opposite pair of edges there, else a part that left with
/// such a pair, else nothing.
void PanelBearings::settle(PanelId panel, Changes& changes) {
  State& own = state(panel);
  std::array<int, 4> where{};
  for (int edge = 0; edge < 4; ++edge)
    where[static_cast<std::size_t>(edge)] = own.holds[static_cast<std::size_t>(edge)] ? bearer(panel, edge) : gone;
  int part = gone;
  for (std::size_t edge = 0; edge < 2; ++edge) {
    if (where[edge] == gone || where[edge] != where[edge + 2]) continue;
    if (part == gone || where[edge] == standing) part = where[edge];
  }
  for (std::size_t edge = 0; edge < 4; ++edge)
    if (part == gone || where[edge] != part) own.holds[edge] = false;
  if (!std::all_of(own.holds.begin(), own.holds.end(), [](bool h) { return h; })) lose_membrane(panel, changes);
  if (part == standing) return;
  own.stands = false;
  lose_membrane(panel, changes);
  const auto is_this = [&](PanelId other) { return other == panel; };
  std::erase_if(changes.lost_edge, is_this);
  if (part == gone)
    changes.fell.push_back(panel);
  else
    changes.carried_off.emplace_back(panel, part);
}

double PanelBearings::intact_length(PanelId panel, int edge) const {
  const std::vector<MemberId>& members = edges_.of(panel, edge);
  const Panel& own = building_[panel];
  const Vec3 along = building_[own.nodes[static_cast<std::size_t>((edge + 1) % 4)]].position -
                     building_[own.nodes[static_cast<std::size_t>(edge)]].position;
  const double left = std::min(along.norm(), state(panel).edge_length[static_cast<std::size_t>(edge)]);
  if (members.empty()) return left;
  // Nodes, not member ends: a rigid offset is part of the edge.
  double length = 0;
  for (MemberId member : members)
    if (member_stands_[index_of(member)])
      length +=
          (building_[building_[member].nodes[1]].position - building_[building_[member].nodes[0]].position).norm();
  return std::min(length, left);
}

std::optional<MemberId> PanelBearings::bearing_member(PanelId panel) const {
  for (int edge = 0; edge < 4; ++edge) {
    if (!holds(panel)[static_cast<std::size_t>(edge)]) continue;
    for (MemberId member : edges_.of(panel, edge))
      if (member_stands_[index_of(member)]) return member;
  }
  return std::nullopt;
}

NodeId PanelBearings::bearing_node(PanelId panel) const {
  for (int edge = 0; edge < 4; ++edge)
    if (holds(panel)[static_cast<std::size_t>(edge)]) return building_[panel].nodes[static_cast<std::size_t>(edge)];
  return building_[panel].nodes[0];
}

}  // namespace topple::structure
