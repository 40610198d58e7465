// What a body that has lost joints falls into.
#include <algorithm>
#include <map>
#include <numeric>

#include "mesh/shell_edges.h"
#include "simulation/impact/free_segment.h"

namespace topple::structure {

namespace {

/// Vertices are members, then nodes, then panels, of which only shells are joined to anything; the least vertex stands
/// for all that hangs together.
class Connection {
 public:
  Connection(const Building& building, const FreeSegmentParts& whole)
      : building_(building),
        whole_(whole),
        first_panel_(whole.members.size() + whole.nodes.size()),
        parent_(first_panel_ + whole.panels.size()),
        part_of_(parent_.size(), -1) {
    for (std::size_t n = 0; n < whole.nodes.size(); ++n) node_vertex_[whole.nodes[n]] = whole.members.size() + n;
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  }

  void join_members(const std::function<bool(JointId)>& holds) {
    for (std::size_t m = 0; m < whole_.members.size(); ++m)
      for (int end = 0; end < 2; ++end) {
        const NodeId node = building_[whole_.members[m]].nodes[static_cast<std::size_t>(end)];
        if (holds(building_.joint(whole_.members[m], end))) join(m, node);
      }
  }

  void join_shells(const std::function<bool(JointId)>& holds) {
    for (std::size_t p = 0; p < whole_.panels.size(); ++p)
      for (int edge = 0; edge < 4 && is_shell(p); ++edge) {
        if (!holds(building_.joint(whole_.panels[p], edge))) continue;
        for (const NodeId node : nodes_of_edge(building_, whole_.panels[p], edge)) join(first_panel_ + p, node);
      }
  }

  /// The parts, in order of their least vertex; panels that are no shells go with what holds them, or alone.
  std::vector<FreeSegmentParts> parts(const FreePanelEdges& edges) {
    for (std::size_t m = 0; m < whole_.members.size(); ++m) {
      FreeSegmentParts& own = part(m);
      own.members.push_back(whole_.members[m]);
      own.member_mass.push_back(whole_.member_mass[m]);
    }
    for (std::size_t n = 0; n < whole_.nodes.size(); ++n) {
      FreeSegmentParts& own = part(whole_.members.size() + n);
      own.nodes.push_back(whole_.nodes[n]);
      own.node_mass.push_back(whole_.node_mass[n]);
    }
    for (std::size_t p = 0; p < whole_.panels.size(); ++p) {
      FreeSegmentParts& own = part_of_panel(p, edges);
      own.panels.push_back(whole_.panels[p]);
      own.panel_mass.push_back(whole_.panel_mass[p]);
    }
    return std::move(parts_);
  }

 private:
  [[nodiscard]] std::size_t find(std::size_t v) {
    while (parent_[v] != v) v = parent_[v] = parent_[parent_[v]];
    return v;
  }
  /// No effect where the node is not in the body.
  void join(std::size_t one, NodeId node) {
    const auto vertex = node_vertex_.find(node);
    if (vertex == node_vertex_.end()) return;
    const std::size_t a = find(one), b = find(vertex->second);
    parent_[std::max(a, b)] = std::min(a, b);
  }
  [[nodiscard]] bool is_shell(std::size_t p) const { return building_[whole_.panels[p]].model == PanelModel::shell; }

  FreeSegmentParts& part(std::size_t vertex) {
    int& number = part_of_[find(vertex)];
    if (number < 0) {
      number = static_cast<int>(parts_.size());
      parts_.emplace_back();
    }
    return parts_[static_cast<std::size_t>(number)];
  }
  FreeSegmentParts& part_numbered(int number) {
    return number < 0 ? parts_.emplace_back() : parts_[static_cast<std::size_t>(number)];
  }
  FreeSegmentParts& part_of_panel(std::size_t p, const FreePanelEdges& edges) {
    if (is_shell(p)) return part(first_panel_ + p);
    if (const auto length = edges ? edges(whole_.panels[p]) : std::nullopt) return part_numbered(holder(p, *length));
    return part_numbered(bearer_of_most_corners(p));
  }
  /// The part that holds two opposite edges of which something is left; -1: none does.
  [[nodiscard]] int holder(std::size_t p, const std::array<double, 4>& length) {
    const auto part_at = [&](std::size_t corner) {
      const auto vertex = node_vertex_.find(building_[whole_.panels[p]].nodes[corner % 4]);
      return vertex == node_vertex_.end() ? -1 : part_of_[find(vertex->second)];
    };
    const auto held_by = [&](std::size_t edge) {
      return length[edge] > 0 && part_at(edge) == part_at(edge + 1) ? part_at(edge) : -1;
    };
    int holder = -1;
    for (const std::size_t edge : {std::size_t{1}, std::size_t{0}})
      if (held_by(edge) >= 0 && held_by(edge) == held_by(edge + 2)) holder = held_by(edge);
    return holder;
  }
  /// -1: no corner is in the body.
  [[nodiscard]] int bearer_of_most_corners(std::size_t p) {
    std::vector<int> corners(parts_.size(), 0);
    for (NodeId node : building_[whole_.panels[p]].nodes)
      if (const auto vertex = node_vertex_.find(node); vertex != node_vertex_.end())
        ++corners[static_cast<std::size_t>(part_of_[find(vertex->second)])];
    const auto most = std::max_element(corners.begin(), corners.end());
    return most == corners.end() || *most == 0 ? -1 : static_cast<int>(most - corners.begin());
  }

  const Building& building_;
  const FreeSegmentParts& whole_;
  std::map<NodeId, std::size_t> node_vertex_;
  std::size_t first_panel_;
  std::vector<std::size_t> parent_;
  std::vector<int> part_of_;  ///< per least vertex: number of its part, -1: none yet
  std::vector<FreeSegmentParts> parts_;
};

}  // namespace

std::vector<FreeSegmentParts> connected_parts(const Building& building, const FreeSegmentParts& whole,
                                              const std::function<bool(JointId)>& holds, const FreePanelEdges& edges) {
  Connection connection(building, whole);
  connection.join_members(holds);
  connection.join_shells(holds);
  return connection.parts(edges);
}

}  // namespace topple::structure
