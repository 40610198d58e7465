#pragma once
// One panel's quadrilaterals: the cells between its mesh lines, less its openings.
#include <array>
#include <vector>

#include "mesh/panel_lines.h"

namespace topple::structure {

struct PanelCells {
  std::vector<Vec2> points;                        ///< s, t
  std::vector<std::array<int, 4>> quadrilaterals;  ///< counter-clockwise against the normal
};

/// Whether a side of an opening cuts through a cell. Then all panels connected with this one are to be `halved`.
[[nodiscard]] bool cuts_cells(const PanelSurface& surface, const Panel& panel, const PanelLines& lines);

/// `halved`: every cell becomes four, so that those that an opening cuts into triangles, quadrilaterals and pentagons
/// become quadrilaterals that match their neighbours.
[[nodiscard]] PanelCells panel_cells(const PanelSurface& surface, const Panel& panel, const PanelLines& lines,
                                     bool halved);

}  // namespace topple::structure
