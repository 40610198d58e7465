#pragma once
// Where the mesh lines of each shell panel lie, so that neighbours' meshes match along the edges they share.
#include <array>
#include <vector>

#include "mesh/panel_edges.h"

namespace topple::structure {

/// Two lines nearer than this share of an edge are one.
inline constexpr double same_line = 1e-4;

struct PanelLines {
  PanelId panel;
  std::array<std::vector<double>, 2> at;  ///< ascending values of s and of t, 0 and 1 included
};

/// One entry for each panel of model shell, in order. Lines go through the corners, nodes of the model on the edges,
/// vertices of openings, the regular divisions that `mesh` asks for, and the ends of neighbours' lines on a common
/// edge, which go on through the panel to the next.
[[nodiscard]] std::vector<PanelLines> panel_lines(const Building& building, const PanelEdges& edges);

/// A number for each entry of `lines`: equal for panels that share an edge or part of one, also by way of others.
[[nodiscard]] std::vector<int> connected_panels(const PanelEdges& edges, const std::vector<PanelLines>& lines);

}  // namespace topple::structure
