#include "mesh/frame_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "index_of.h"
#include "mesh/panel_cells.h"
#include "mesh/point_index.h"
#include "topple/structure/error.h"

namespace topple::structure {

namespace {

/// Points of two panels on a common edge are one when they are nearer than this share of it.
constexpr double same_point = 2 * same_line;

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
  Mesher(const Building& building, Frame& frame) : building_(building), frame_(frame), on_edges_(reach(building)) {
    for (std::size_t n = 0; n < building.nodes.size(); ++n)
      on_edges_.add(building.nodes[n].position, static_cast<int>(n));
  }

  void mesh(const PanelLines& lines, bool halved) {
    const Panel& panel = building_[lines.panel];
    const PanelSurface surface(building_, panel);
    const PanelCells cells = panel_cells(surface, panel, lines, halved);
    if (cells.quadrilaterals.empty())
      throw InputError("panels." + panel.name + ".openings: nothing is left of the panel; accepted: smaller openings");
    PanelMesh& mesh = frame_.meshes[index_of(lines.panel)];
    const std::vector<int> nodes = place(panel, surface, cells.points, mesh);
    mesh.first_shell = static_cast<int>(frame_.model.shells.size());
    for (const auto& cell : cells.quadrilaterals) {
      solver::Shell shell = shell_of(panel);
      for (std::size_t i = 0; i < 4; ++i) shell.node[i] = nodes[static_cast<std::size_t>(cell[i])];
      mesh.elements.push_back(shell.node);
      frame_.model.shells.push_back(shell);
    }
  }

 private:
  static double reach(const Building& building) {
    double longest = 0;
    for (const Panel& panel : building.panels)
      if (panel.model == PanelModel::shell) longest = std::max(longest, PanelSurface(building, panel).size());
    return same_point * longest;
  }

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
  std::vector<int> place(const Panel& panel, const PanelSurface& surface, const std::vector<Vec2>& points,
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

  int node_at(const Panel& panel, const PanelSurface& surface, const Vec2& st) {
    double edge_length = 0;
    for (std::size_t edge = 0; edge < 4; ++edge)
      if (const auto along = along_edge(edge, st)) {
        if (*along == 0) return panel.nodes[edge].index;
        if (*along == 1) return panel.nodes[(edge + 1) % 4].index;
        edge_length = surface.edge_length(edge);
      }
    const Vec3 place = surface.at(st);
    if (edge_length > 0)
      if (const int found = on_edges_.nearest(place, same_point * edge_length); found >= 0) return found;
    const int node = static_cast<int>(frame_.model.nodes.size());
    frame_.model.nodes.push_back(place);
    if (edge_length > 0) on_edges_.add(place, node);
    return node;
  }

  const Building& building_;
  Frame& frame_;
  PointIndex on_edges_;
};

}  // namespace

void add_shell_panels(const Building& building, Frame& frame) {
  frame.meshes.resize(building.panels.size());
  const std::vector<PanelLines> lines = panel_lines(building);
  if (lines.empty()) return;
  const std::vector<int> group = connected_panels(building, lines);
  std::vector<char> halved(lines.size(), 0);
  for (std::size_t k = 0; k < lines.size(); ++k) {
    const Panel& panel = building[lines[k].panel];
    if (!panel.openings.empty() && cuts_cells(PanelSurface(building, panel), panel, lines[k]))
      halved[static_cast<std::size_t>(group[k])] = 1;
  }
  Mesher mesher(building, frame);
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
