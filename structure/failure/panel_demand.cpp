#include "failure/panel_demand.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "model/index_of.h"

namespace topple::structure {

Mat3 edge_axes(const Building& building, const Panel& panel, std::size_t edge) {
  const Vec3 along =
      (building[panel.nodes[(edge + 1) % 4]].position - building[panel.nodes[edge]].position).normalized();
  const Vec3 normal = panel.axes.row(2);
  Mat3 axes;
  axes.row(0) = along.cross(normal).normalized();
  axes.row(1) = along;
  axes.row(2) = normal;
  return axes;
}

namespace {

double area(const Building& building, const Panel& panel) {
  const auto corner = [&](std::size_t i) -> const Vec3& { return building[panel.nodes[i]].position; };
  return 0.5 * (corner(2) - corner(0)).cross(corner(3) - corner(1)).norm();
}

}  // namespace

Vec6 handed_edge_demand(const Building& building, const PanelBearings& bearings, PanelId panel, int edge,
                        const Vec3& force) {
  Vec6 demand = Vec6::Zero();
  const double length = bearings.intact_length(panel, edge);
  if (length > 0)
    demand.head<3>() = -(edge_axes(building, building[panel], static_cast<std::size_t>(edge)) * force) / length;
  return demand;
}

namespace {

/// Mean membrane force per length, global axes.
Mat3 mean_membrane_force(const Building& building, const Panel& panel, const std::array<Vec6, 4>& corner_forces) {
  const Vec3 origin = building[panel.nodes[0]].position;
  Mat3 virial = Mat3::Zero();
  for (std::size_t corner = 0; corner < 4; ++corner)
    virial += corner_forces[corner].head<3>() * (building[panel.nodes[corner]].position - origin).transpose();
  return 0.5 * (virial + virial.transpose()) / area(building, panel);
}

}  // namespace

PanelStress mean_membrane_stress(const Building& building, PanelId id, const std::array<Vec6, 4>& corner_forces) {
  const Panel& panel = building[id];
  const Mat3 local =
      panel.axes * mean_membrane_force(building, panel, corner_forces) * panel.axes.transpose() / panel.thickness;
  const double mean = (local(0, 0) + local(1, 1)) / 2;
  const double radius = std::hypot((local(0, 0) - local(1, 1)) / 2, local(0, 1));
  PanelStress stress;
  stress.tension = std::max(0.0, mean + radius);
  stress.compression = std::max(0.0, radius - mean);
  for (const NodeId node : panel.nodes) stress.tension_at += building[node].position / 4;
  stress.compression_at = stress.tension_at;
  return stress;
}

PanelEdgeAxes panel_edge_axes(const Building& building, PanelId id) {
  const Panel& panel = building[id];
  PanelEdgeAxes edges;
  for (std::size_t i = 0; i < 4; ++i) {
    edges.corner[i] = building[panel.nodes[i]].position - building[panel.nodes[0]].position;
    edges.axes[i] = edge_axes(building, panel, i);
  }
  edges.area = area(building, panel);
  return edges;
}

std::array<Vec6, 4> membrane_edge_demands(const PanelEdgeAxes& edges, const std::array<Vec6, 4>& corner_forces) {
  Mat3 virial = Mat3::Zero();
  for (std::size_t corner = 0; corner < 4; ++corner)
    virial += corner_forces[corner].head<3>() * edges.corner[corner].transpose();
  const Mat3 stress = 0.5 * (virial + virial.transpose()) / edges.area;
  std::array<Vec6, 4> demands;
  for (std::size_t edge = 0; edge < 4; ++edge) {
    const Mat3& axes = edges.axes[edge];
    const Vec3 traction = axes * (stress * axes.row(0).transpose());
    demands[edge] << traction(0), traction(1), 0, 0, 0, 0;
  }
  return demands;
}

std::array<Vec6, 4> membrane_edge_demands(const Building& building, PanelId id,
                                          const std::array<Vec6, 4>& corner_forces) {
  return membrane_edge_demands(panel_edge_axes(building, id), corner_forces);
}

std::array<Vec6, 4> panel_edge_demands(const Building& building, const PanelBearings& bearings, const FrameLoads& loads,
                                       PanelId panel, const std::optional<std::array<Vec6, 4>>& corner_forces) {
  std::array<Vec6, 4> demands{Vec6::Zero(), Vec6::Zero(), Vec6::Zero(), Vec6::Zero()};
  if (corner_forces) demands = membrane_edge_demands(building, panel, *corner_forces);
  for (int edge = 0; edge < 4; ++edge) {
    const auto e = static_cast<std::size_t>(edge);
    if (bearings.holds(panel)[e])
      demands[e] += handed_edge_demand(building, bearings, panel, edge, loads.edge_force(panel, edge));
    else
      demands[e].setZero();
  }
  return demands;
}

}  // namespace topple::structure
