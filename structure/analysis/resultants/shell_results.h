#pragma once
// What shell panels and the supports of their edges bear.
#include <array>

#include "analysis/bearing_edges.h"
#include "topple/solver/shell_resultants.h"
#include "topple/structure/analysis.h"
#include "topple/structure/frame.h"

namespace topple::structure {

/// What the nodes of element `element` of a meshed panel do to it, global.
[[nodiscard]] std::array<Vec6, 4> element_forces(const Building& building, const Frame& frame, PanelId panel,
                                                 std::size_t element, const PartLoads& loads,
                                                 const solver::StaticSolution& solution);

/// Resultants of every element of a meshed panel, those at the panel's centre (the mean of the elements nearest to it),
/// and forces at the panel's corners.
[[nodiscard]] PanelResult shell_panel_result(const Building& building, const Frame& frame, PanelId panel,
                                             const PartLoads& loads, const solver::StaticSolution& solution);

/// Resultants in the panel's axes at the centres of its elements, and at their 2 x 2 Gauss points (towards corner 1 to
/// 4), where the elements' own fields are compared with a smooth one.
struct PanelResultants {
  std::vector<solver::ShellResultants> centre;
  std::vector<std::array<solver::ShellResultants, 4>> gauss;
};
[[nodiscard]] PanelResultants panel_resultants(const Building& building, const Frame& frame, PanelId panel,
                                               const PartLoads& loads, const solver::StaticSolution& solution);

/// What openings leave of the length of each edge of a meshed panel.
[[nodiscard]] std::array<double, 4> intact_edges(const Frame& frame, PanelId panel);

/// Resultant over each edge of what its supports, and members and panels along it, do to the panel (the forces of its
/// nodes, in balance with the panel's loads), per intact length, in the axes of the edge. Corners are shared as
/// edge_share() says. Zero for a free edge, and where openings leave nothing of it.
[[nodiscard]] std::array<Vec6, 4> shell_edge_demands(const Building& building, const Frame& frame,
                                                     const BearingEdges& bearing, PanelId panel, const PartLoads& loads,
                                                     const solver::StaticSolution& solution);

/// Resultant of each support of a panel's edge, moments about the middle of the edge, global axes.
[[nodiscard]] std::vector<Vec6> edge_reactions(const Building& building, const Frame& frame,
                                               const std::vector<Vec6>& reactions);

}  // namespace topple::structure
