#pragma once
// What the edge joints of a membrane or cladding panel bear.
#include <optional>

#include "loads/frame_loads.h"

namespace topple::structure {

/// Of a panel's edge, as its joints see it. Rows: outwards across the edge, along it, normal.
[[nodiscard]] Mat3 edge_axes(const Building& building, const Panel& panel, std::size_t edge);

/// Demand of each edge joint per intact length, in the axes of the edge (x outwards, y along, z normal); zero for an
/// edge that no longer holds. It is what the support does to the panel: the reaction to the load handed to that edge,
/// plus the traction of the mean membrane stress, which follows from the corner forces c_i at x_i by the virial
/// theorem, N = sum of c_i x_i' / area (exact for any stress field without body force).
[[nodiscard]] std::array<Vec6, 4> panel_edge_demands(const Building& building, const PanelBearings& bearings,
                                                     const FrameLoads& loads, PanelId panel,
                                                     const std::optional<std::array<Vec6, 4>>& corner_forces);

/// What the traction on a panel's edges is found from: corners seen from the first one, axes of the edges (rows:
/// outwards, along, normal), area.
struct PanelEdgeAxes {
  std::array<Vec3, 4> corner;
  std::array<Mat3, 4> axes;
  double area = 0;
};
[[nodiscard]] PanelEdgeAxes panel_edge_axes(const Building& building, PanelId panel);

/// The same for the traction alone.
[[nodiscard]] std::array<Vec6, 4> membrane_edge_demands(const PanelEdgeAxes& edges,
                                                        const std::array<Vec6, 4>& corner_forces);
[[nodiscard]] std::array<Vec6, 4> membrane_edge_demands(const Building& building, PanelId panel,
                                                        const std::array<Vec6, 4>& corner_forces);
/// Principal values of the mean membrane stress (over the thickness), at the panel's centre.
[[nodiscard]] PanelStress mean_membrane_stress(const Building& building, PanelId panel,
                                               const std::array<Vec6, 4>& corner_forces);
/// The same for a force that the panel hands to an edge, global axes.
[[nodiscard]] Vec6 handed_edge_demand(const Building& building, const PanelBearings& bearings, PanelId panel, int edge,
                                      const Vec3& force);

}  // namespace topple::structure
