#include "mesh/frame_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <optional>

#include "mesh/panel_cells.h"
#include "model/index_of.h"
#include "topple/structure/error.h"

namespace topple::structure {

namespace {

/// Points of two panels on a common segment are one when they are nearer than this share of it: less than the least
/// distance of two lines, more than what a line may be off its neighbour's.
constexpr double same_point = 0.9 * same_line;

/// Parameters within this of 0 and 1 are on the border.
constexpr double on_border = 1e-8;

double onto_border(double parameter) {
  if (std::abs(parameter) < on_border) return 0;
  return std::abs(parameter - 1) < on_border ? 1 : parameter;
}

/// How far along an edge a point lies, if it is on it.
std::optional<double> along_edge(std::size_t edge, const Vec2& st) {
  const double across = edge % 2 == 0 ? st.y() : st.x();
  const double border = edge == 1 || edge == 2 ? 1 : 0;
  if (across != border) return std::nullopt;
  return PanelSurface::line_of(edge, edge % 2 == 0 ? st.x() : st.y());
}

class Mesher {
 public:
  Mesher(const Building& building, const PanelEdges& edges, Frame& frame)
      : building_(building), edges_(edges), frame_(frame) {}

  void mesh(const PanelLines& lines, bool halved) {
    const Panel& panel = building_[lines.panel];
    const PanelSurface surface(building_, panel);
    const PanelCells cells = panel_cells(surface, panel, lines, halved);
    if (cells.quadrilaterals.empty())
      throw InputError("panels." + panel.name + ".openings: nothing is left of the panel; accepted: smaller openings");
    PanelMesh& mesh = frame_.meshes[index_of(lines.panel)];
    const std::vector<int> nodes = nodes_of_points(lines.panel, surface, cells.points, mesh);
    mesh.first_shell = static_cast<int>(frame_.model.shells.size());
    for (const auto& cell : cells.quadrilaterals) {
      solver::Shell shell = shell_of(panel);
      for (std::size_t i = 0; i < 4; ++i) shell.node[i] = nodes[static_cast<std::size_t>(cell[i])];
      mesh.elements.push_back(shell.node);
      frame_.model.shells.push_back(shell);
    }
  }

 private:
  [[nodiscard]] solver::Shell shell_of(const Panel& panel) const {
    const Material& material = building_[panel.material];
    solver::Shell shell;
    shell.youngs_modulus = material.youngs_modulus;
    shell.poisson_ratio = material.poisson_ratio;
    shell.thickness = panel.thickness;
    shell.density = material.density;
    shell.bending = true;
    return shell;
  }

  /// The frame's nodes for a panel's points; new ones for those that nobody has.
  std::vector<int> nodes_of_points(PanelId panel, const PanelSurface& surface, const std::vector<Vec2>& points,
                                   PanelMesh& mesh) {
    std::vector<int> nodes;
    std::array<std::vector<std::pair<double, int>>, 4> on_edge;
    for (const Vec2& point : points) {
      const Vec2 st(onto_border(point.x()), onto_border(point.y()));
      nodes.push_back(node_at(panel, surface, st));
      for (std::size_t edge = 0; edge < 4; ++edge)
        if (const auto along = along_edge(edge, st)) on_edge[edge].emplace_back(*along, nodes.back());
    }
    for (std::size_t edge = 0; edge < 4; ++edge) {
      std::sort(on_edge[edge].begin(), on_edge[edge].end());
      for (const auto& [along, node] : on_edge[edge]) mesh.edge_nodes[edge].push_back(node);
    }
    return nodes;
  }

  int node_at(PanelId panel, const PanelSurface& surface, const Vec2& st) {
    for (std::size_t edge = 0; edge < 4; ++edge)
      if (const auto along = along_edge(edge, st)) return node_on_edge(panel, edge, *along, surface.at(st));
    return new_node(surface.at(st));
  }

  int node_on_edge(PanelId panel, std::size_t edge, double along, const Vec3& place) {
    for (const EdgeNode& node : edges_.nodes(panel, edge))
      if (std::abs(node.at - along) < same_point) return node.node;
    const EdgePlace on_segment = edges_.position(panel, edge, along);
    auto& shared = on_segments_[on_segment.segment];
    for (const auto& [at, node] : shared)
      if (std::abs(at - on_segment.at) < same_point) return node;
    shared.emplace_back(on_segment.at, new_node(place));
    return shared.back().second;
  }

  int new_node(const Vec3& place) {
    frame_.model.nodes.push_back(place);
    return static_cast<int>(frame_.model.nodes.size()) - 1;
  }

  const Building& building_;
  const PanelEdges& edges_;
  Frame& frame_;
  std::map<EdgeSegment, std::vector<std::pair<double, int>>> on_segments_;  ///< mesh nodes by their place
};

}  // namespace

void add_shell_panels(const Building& building, Frame& frame) {
  frame.meshes.resize(building.panels.size());
  const PanelEdges edges(building);
  const std::vector<PanelLines> lines = panel_lines(building, edges);
  if (lines.empty()) return;
  const std::vector<int> group = connected_panels(edges, lines);
  std::vector<char> halved(lines.size(), 0);
  for (std::size_t k = 0; k < lines.size(); ++k) {
    const Panel& panel = building[lines[k].panel];
    if (!panel.openings.empty() && cuts_cells(PanelSurface(building, panel), panel, lines[k]))
      halved[static_cast<std::size_t>(group[k])] = 1;
  }
  Mesher mesher(building, edges, frame);
  for (std::size_t k = 0; k < lines.size(); ++k) mesher.mesh(lines[k], halved[static_cast<std::size_t>(group[k])] != 0);
}

void add_edge_supports(const Building& building, Frame& frame) {
  for (const EdgeSupport& support : building.edge_supports) {
    frame.edge_supports.emplace_back();
    for (const int node : frame.meshes[index_of(support.panel)].edge_nodes[static_cast<std::size_t>(support.edge)]) {
      frame.edge_supports.back().push_back(static_cast<int>(frame.model.supports.size()));
      frame.model.supports.push_back({node, support.stiffness});
    }
  }
}

}  // namespace topple::structure
