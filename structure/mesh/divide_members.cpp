// Members along the edges of shell panels, divided at the mesh's nodes.
#include <algorithm>

#include "mesh/frame_mesh.h"
#include "mesh/panel_edges.h"
#include "model/index_of.h"
#include "topple/structure/error.h"

namespace topple::structure {

namespace {

struct Cut {
  double at;  ///< distance from the member's first end
  int node;
};

class Cuts {
 public:
  Cuts(const Building& building, const Frame& frame)
      : building_(building), frame_(frame), at_node_(building.nodes.size()), of_member(building.members.size()) {
    for (std::size_t m = 0; m < building.members.size(); ++m)
      if (building.members[m].axial == AxialAction::both) at_node_[first_node(m)].push_back(m);
  }

  /// `on_edge`: nodes of the model on an edge; `mesh`: those of the mesh.
  void add_edge(const std::vector<EdgeNode>& on_edge, const std::vector<int>& mesh) {
    const auto has = [&](NodeId id) {
      return std::any_of(on_edge.begin(), on_edge.end(), [&](const EdgeNode& node) { return node.node == id.index; });
    };
    for (const EdgeNode& node : on_edge)
      for (const std::size_t m : at_node_[static_cast<std::size_t>(node.node)])
        if (has(building_.members[m].nodes[1])) cut(m, mesh);
  }

 private:
  [[nodiscard]] std::size_t first_node(std::size_t member) const {
    return index_of(building_.members[member].nodes[0]);
  }

  void cut(std::size_t m, const std::vector<int>& nodes) {
    const Member& member = building_.members[m];
    const auto place = [&](int node) -> const Vec3& { return frame_.model.nodes[static_cast<std::size_t>(node)]; };
    const Vec3 x = member.axes.row(0), start = place(member.nodes[0].index) + member.offsets[0];
    constexpr double least_piece = 1e-6;  // of the member's length
    for (const int node : nodes) {
      const double at = (place(node) - start).dot(x);
      if (at < least_piece * member.length || at > (1 - least_piece) * member.length) continue;
      const auto same = [&](const Cut& other) { return other.node == node; };
      if (std::none_of(of_member[m].begin(), of_member[m].end(), same)) of_member[m].push_back({at, node});
    }
  }

  const Building& building_;
  const Frame& frame_;
  std::vector<std::vector<std::size_t>> at_node_;  ///< members whose first end is at a node

 public:
  std::vector<std::vector<Cut>> of_member;
};

void divide(const Member& member, std::size_t index, std::vector<Cut> cuts, Frame& frame) {
  std::sort(cuts.begin(), cuts.end(), [](const Cut& a, const Cut& b) { return a.at < b.at; });
  std::vector<solver::Beam>& beams = frame.model.beams;
  const solver::Beam whole = beams[index];
  const Vec3 x = member.axes.row(0);
  const Vec3 start = frame.model.nodes[static_cast<std::size_t>(whole.node[0])] + whole.offset[0];
  std::vector<MemberPiece>& pieces = frame.pieces[index];
  for (std::size_t i = 0; i <= cuts.size(); ++i) {
    solver::Beam piece = whole;
    const double from = i == 0 ? 0 : cuts[i - 1].at, to = i == cuts.size() ? whole.length : cuts[i].at;
    piece.length = to - from;
    const auto tie = [&](std::size_t end, const Cut& cut) {
      piece.node[end] = cut.node;
      piece.offset[end] = start + cut.at * x - frame.model.nodes[static_cast<std::size_t>(cut.node)];
      // A member on the edge itself has no arm, whatever the rounding of its division.
      constexpr double rounding = 1e-12;
      if (piece.offset[end].norm() < rounding * whole.length) piece.offset[end].setZero();
      piece.end_stiffness[end].setConstant(solver::rigid);
    };
    if (i > 0) tie(0, cuts[i - 1]);
    if (i < cuts.size()) tie(1, cuts[i]);
    pieces.push_back({i == 0 ? static_cast<int>(index) : static_cast<int>(beams.size()), from});
    if (i == 0)
      beams[index] = piece;
    else
      beams.push_back(piece);
  }
}

}  // namespace

void divide_members(const Building& building, Frame& frame) {
  frame.pieces.resize(building.members.size());
  Cuts cuts(building, frame);
  const PanelEdges edges(building);
  for (std::size_t p = 0; p < building.panels.size(); ++p)
    for (std::size_t edge = 0; edge < 4; ++edge)
      cuts.add_edge(edges.nodes(PanelId(p), edge), frame.meshes[p].edge_nodes[edge]);
  for (std::size_t m = 0; m < building.members.size(); ++m)
    if (!cuts.of_member[m].empty()) divide(building.members[m], m, std::move(cuts.of_member[m]), frame);
}

std::vector<std::vector<int>> divide_evenly(const Building& building, int pieces, Frame& frame) {
  std::vector<std::vector<int>> added(building.members.size());
  const NameIndex names(building);
  for (std::size_t m = 0; m < building.members.size() && pieces > 1; ++m) {
    const Member& member = building.members[m];
    if (!frame.pieces[m].empty() || member.axial != AxialAction::both) continue;
    std::vector<Vec3>& nodes = frame.model.nodes;
    const Vec3 x = member.axes.row(0), start = nodes[index_of(member.nodes[0])] + member.offsets[0];
    std::vector<Cut> cuts;
    for (int i = 1; i < pieces; ++i) {
      if (const std::string name = member.name + "/cut-" + std::to_string(i); names.node(name))
        throw InputError(building.file + ": \"" + name + "\" is the name of an inner node of a divided member; " +
                         "expected nodes of other names");
      const double at = member.length * i / pieces;
      cuts.push_back({at, static_cast<int>(nodes.size())});
      added[m].push_back(cuts.back().node);
      nodes.emplace_back(start + at * x);
    }
    divide(member, m, std::move(cuts), frame);
  }
  return added;
}

}  // namespace topple::structure
