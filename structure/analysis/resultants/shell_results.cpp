#include "analysis/resultants/shell_results.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>

#include "failure/panel_demand.h"
#include "mesh/semi_rigid_elements.h"
#include "mesh/shell_edges.h"
#include "model/index_of.h"
#include "topple/solver/shell_resultants.h"

namespace topple::structure {

namespace {

using solver::ShellResultants;

/// Resultants in axes turned about the normal: the new x has these components in the old axes.
ShellResultants turned(const ShellResultants& r, double c, double s) {
  const auto tensor = [&](const Vec3& t) {
    return Vec3(c * c * t(0) + s * s * t(1) + 2 * c * s * t(2), s * s * t(0) + c * c * t(1) - 2 * c * s * t(2),
                c * s * (t(1) - t(0)) + (c * c - s * s) * t(2));
  };
  ShellResultants result;
  result.membrane = tensor(r.membrane);
  result.moments = tensor(r.moments);
  result.shears << c * r.shears(0) + s * r.shears(1), c * r.shears(1) - s * r.shears(0);
  return result;
}

class PanelReader {
 public:
  PanelReader(const Building& building, const Frame& frame, PanelId id, double strain,
              const solver::StaticSolution& solution)
      : panel_(building[id]), mesh_(frame.meshes[index_of(id)]), frame_(frame), strain_(strain), solution_(solution) {}

  [[nodiscard]] std::size_t elements() const { return mesh_.elements.size(); }
  [[nodiscard]] const Vec3& position(std::size_t element, std::size_t corner) const {
    return frame_.model.nodes[static_cast<std::size_t>(mesh_.elements[element][corner % 4])];
  }
  [[nodiscard]] Vec3 centre(std::size_t element) const {
    return (position(element, 0) + position(element, 1) + position(element, 2) + position(element, 3)) / 4;
  }
  /// In axes whose x lies along `x`, a direction in the panel; at a place of the element (-1 to 1 both ways).
  [[nodiscard]] ShellResultants resultants(std::size_t element, const Vec3& x, const Vec2& at = Vec2::Zero()) const {
    const ShellResultants own = own_axes(element, at);
    const Vec3 normal = panel_.axes.row(2);
    const Vec3 from = (position(element, 1) - position(element, 0)).normalized();
    const double c = from.dot(x), s = normal.dot(from.cross(x)), length = std::hypot(c, s);
    return turned(own, c / length, s / length);
  }

 private:
  [[nodiscard]] ShellResultants own_axes(std::size_t element, const Vec2& at) const {
    const int shell = mesh_.first_shell + static_cast<int>(element);
    if (semi_rigid_element(frame_, shell) == nullptr)
      return solver::shell_resultants(frame_.model, shell, solution_.displacements, strain_, at);
    solver::FrameModel alone;  // with the displacements of its own side of the joints
    std::vector<Vec6> displacements;
    for (std::size_t c = 0; c < 4; ++c) {
      alone.nodes.push_back(position(element, c));
      displacements.push_back(solution_.displacements[static_cast<std::size_t>(mesh_.elements[element][c])]);
    }
    alone.shells = {frame_.model.shells[static_cast<std::size_t>(shell)]};
    alone.shells.front().node = {0, 1, 2, 3};
    return solver::shell_resultants(alone, 0, displacements, strain_, at);
  }

  const Panel& panel_;
  const PanelMesh& mesh_;
  const Frame& frame_;
  double strain_;
  const solver::StaticSolution& solution_;
};

bool contains(const std::vector<int>& nodes, int node) {
  return std::find(nodes.begin(), nodes.end(), node) != nodes.end();
}

PanelElement element_of(const ShellResultants& r, const std::array<int, 4>& nodes) {
  PanelElement element;
  element.nodes = nodes;
  for (std::size_t i = 0; i < 3; ++i) {
    element.membrane[i] = r.membrane(static_cast<Eigen::Index>(i));
    element.moments[i] = r.moments(static_cast<Eigen::Index>(i));
  }
  element.shears = {r.shears(0), r.shears(1)};
  return element;
}

/// Mean of the elements whose centres lie nearest to the panel's.
void set_centre(const PanelReader& reader, const Vec3& centre, double size, PanelResult& result) {
  constexpr double equally_near = 1e-6;  // of the panel's size
  double least = 1e300;
  for (std::size_t k = 0; k < reader.elements(); ++k) least = std::min(least, (reader.centre(k) - centre).norm());
  double count = 0;
  for (std::size_t k = 0; k < reader.elements(); ++k) {
    if ((reader.centre(k) - centre).norm() > least + equally_near * size) continue;
    count += 1;
    for (std::size_t i = 0; i < 3; ++i) {
      result.membrane[i] += result.elements[k].membrane[i];
      result.moments[i] += result.elements[k].moments[i];
      if (i < 2) result.shears[i] += result.elements[k].shears[i];
    }
  }
  for (std::size_t i = 0; i < 3; ++i) {
    result.membrane[i] /= count;
    result.moments[i] /= count;
    if (i < 2) result.shears[i] /= count;
  }
}

}  // namespace

std::array<Vec6, 4> element_forces(const Building& building, const Frame& frame, PanelId id, std::size_t k,
                                   const PartLoads& loads, const solver::StaticSolution& solution) {
  const int shell = frame.meshes[index_of(id)].first_shell + static_cast<int>(k);
  const SemiRigidElement* semi_rigid = semi_rigid_element(frame, shell);
  if (semi_rigid == nullptr) return solution.shell_corner_forces[static_cast<std::size_t>(shell)];
  const PanelAction& action = loads.panels[index_of(id)];
  const Vec3 traction = action.body_force - action.pressure * Vec3(building[id].axes.row(2));
  return element_corner_forces(frame, *semi_rigid, solution, traction, action.strain);
}

PanelResultants panel_resultants(const Building& building, const Frame& frame, PanelId id, const PartLoads& loads,
                                 const solver::StaticSolution& solution) {
  const PanelReader reader(building, frame, id, loads.panels[index_of(id)].strain, solution);
  const Vec3 x = building[id].axes.row(0);
  PanelResultants all;
  constexpr double gauss = 0.57735026918962576;
  for (std::size_t k = 0; k < reader.elements(); ++k) {
    all.centre.push_back(reader.resultants(k, x));
    auto& points = all.gauss.emplace_back();
    for (std::size_t g = 0; g < 4; ++g)
      points[g] = reader.resultants(k, x, Vec2((g == 1 || g == 2 ? 1 : -1) * gauss, (g >= 2 ? 1 : -1) * gauss));
  }
  return all;
}

PanelResult shell_panel_result(const Building& building, const Frame& frame, PanelId id, const PartLoads& loads,
                               const solver::StaticSolution& solution) {
  const Panel& panel = building[id];
  const PanelMesh& mesh = frame.meshes[index_of(id)];
  const PanelReader reader(building, frame, id, loads.panels[index_of(id)].strain, solution);
  PanelResult result;
  result.corner_forces.fill(Vec6::Zero());
  for (std::size_t k = 0; k < mesh.elements.size(); ++k) {
    result.elements.push_back(element_of(reader.resultants(k, panel.axes.row(0)), mesh.elements[k]));
    const std::array<Vec6, 4> forces = element_forces(building, frame, id, k, loads, solution);
    const auto& nodes = frame.model.shells[static_cast<std::size_t>(mesh.first_shell) + k].node;
    for (std::size_t c = 0; c < 4; ++c)
      for (std::size_t corner = 0; corner < 4; ++corner)
        if (nodes[c] == panel.nodes[corner].index) result.corner_forces[corner] += forces[c];
  }
  Vec3 centre = Vec3::Zero();
  for (const NodeId node : panel.nodes) centre += building[node].position / 4;
  set_centre(reader, centre, (building[panel.nodes[2]].position - centre).norm(), result);
  return result;
}

std::array<double, 4> intact_edges(const Frame& frame, PanelId panel) {
  const PanelMesh& mesh = frame.meshes[index_of(panel)];
  std::array<double, 4> intact{};
  for (const std::array<int, 4>& element : mesh.elements)
    for (std::size_t c = 0; c < 4; ++c) {
      const int node = element[c], next = element[(c + 1) % 4];
      const auto place = [&](int at) { return frame.model.nodes[static_cast<std::size_t>(at)]; };
      for (std::size_t edge = 0; edge < 4; ++edge)
        if (contains(mesh.edge_nodes[edge], node) && contains(mesh.edge_nodes[edge], next))
          intact[edge] += (place(next) - place(node)).norm();
    }
  return intact;
}

std::array<Vec6, 4> shell_edge_demands(const Building& building, const Frame& frame, const BearingEdges& bearing,
                                       PanelId id, const PartLoads& loads, const solver::StaticSolution& solution) {
  const Panel& panel = building[id];
  const PanelMesh& mesh = frame.meshes[index_of(id)];
  std::map<int, Vec6> at_node;  // what each node of an edge does to the panel
  for (const auto& on_edge : mesh.edge_nodes)
    for (const int node : on_edge) at_node.emplace(node, Vec6::Zero());
  for (std::size_t k = 0; k < mesh.elements.size(); ++k) {
    const std::array<Vec6, 4> forces = element_forces(building, frame, id, k, loads, solution);
    for (std::size_t c = 0; c < 4; ++c)
      if (const auto own = at_node.find(mesh.elements[k][c]); own != at_node.end()) own->second += forces[c];
  }
  const std::array<double, 4> intact = intact_edges(frame, id);
  const std::array<bool, 4> bears = bearing.of(id);
  std::array<Vec6, 4> demands{Vec6::Zero(), Vec6::Zero(), Vec6::Zero(), Vec6::Zero()};
  for (std::size_t edge = 0; edge < 4; ++edge) {
    if (!(intact[edge] > 0)) continue;
    for (const int node : mesh.edge_nodes[edge]) {
      const double share = edge_share(panel, bears, edge, NodeId(static_cast<std::size_t>(node)));
      if (share > 0) demands[edge] += share * at_node.at(node);
    }
    const Mat3 axes = edge_axes(building, panel, edge);
    demands[edge] << axes * demands[edge].head<3>() / intact[edge], axes * demands[edge].tail<3>() / intact[edge];
  }
  return demands;
}

namespace {

/// What holds one component of a node rigidly for several edges, a corner, bears it in equal parts: the solver leaves
/// it with one of them.
std::vector<Vec6> shared_at_corners(const Frame& frame, std::vector<Vec6> reactions) {
  std::map<std::pair<int, int>, std::vector<std::size_t>> holding;  // by node and component
  for (const std::vector<int>& supports : frame.edge_supports)
    for (const int s : supports) {
      const solver::Support& support = frame.model.supports[static_cast<std::size_t>(s)];
      for (int c = 0; c < 6; ++c)
        if (support.stiffness(c) == unlimited) holding[{support.node, c}].push_back(static_cast<std::size_t>(s));
    }
  for (const auto& [place, supports] : holding) {
    if (supports.size() < 2) continue;
    double sum = 0;
    for (const std::size_t s : supports) sum += reactions[s](place.second);
    for (const std::size_t s : supports) reactions[s](place.second) = sum / static_cast<double>(supports.size());
  }
  return reactions;
}

}  // namespace

std::vector<Vec6> edge_reactions(const Building& building, const Frame& frame, const std::vector<Vec6>& given) {
  std::vector<Vec6> all;
  const std::vector<Vec6> reactions = shared_at_corners(frame, given);
  for (std::size_t i = 0; i < building.edge_supports.size(); ++i) {
    const EdgeSupport& support = building.edge_supports[i];
    const auto& nodes = building[support.panel].nodes;
    const auto edge = static_cast<std::size_t>(support.edge);
    const Vec3 middle = (building[nodes[edge]].position + building[nodes[(edge + 1) % 4]].position) / 2;
    Vec6 sum = Vec6::Zero();
    for (const int s : frame.edge_supports[i]) {
      const Vec6& reaction = reactions[static_cast<std::size_t>(s)];
      const Vec3 force = reaction.head<3>();
      const int node = frame.model.supports[static_cast<std::size_t>(s)].node;
      sum += reaction;
      sum.tail<3>() += (frame.model.nodes[static_cast<std::size_t>(node)] - middle).cross(force);
    }
    all.push_back(sum);
  }
  return all;
}

}  // namespace topple::structure
