#pragma once
// What shell panels and the supports of their edges bear.
#include <array>

#include "topple/structure/analysis.h"
#include "topple/structure/frame.h"

namespace topple::structure {

/// Resultants of every element of a meshed panel, those at the panel's centre (the mean of the elements nearest to it),
/// and forces at the panel's corners.
[[nodiscard]] PanelResult shell_panel_result(const Building& building, const Frame& frame, PanelId panel,
                                             const PartLoads& loads, const solver::StaticSolution& solution);

/// Mean traction of each edge per intact length, in the axes of the edge: what the support does to the panel. Zero
/// where openings leave nothing of the edge.
[[nodiscard]] std::array<Vec6, 4> shell_edge_demands(const Building& building, const Frame& frame, PanelId panel,
                                                     const PartLoads& loads, const solver::StaticSolution& solution);

/// Resultant of each support of a panel's edge, moments about the middle of the edge, global axes.
[[nodiscard]] std::vector<Vec6> edge_reactions(const Building& building, const Frame& frame,
                                               const std::vector<Vec6>& reactions);

}  // namespace topple::structure
