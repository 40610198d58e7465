#pragma once
// Area of the material of a panel.
#include <cmath>

#include "topple/structure/building.h"

namespace topple::structure {

/// Of the outline in the panel's plane, m2; `openings`: taken off.
[[nodiscard]] inline double panel_area(const Building& building, const Panel& panel, bool less_openings) {
  const auto area = [](const std::vector<Vec2>& polygon) {
    double doubled = 0;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Vec2 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
      doubled += a.x() * b.y() - a.y() * b.x();
    }
    return std::abs(doubled) / 2;
  };
  std::vector<Vec2> outline;
  for (const NodeId node : panel.nodes)
    outline.push_back((panel.axes * (building[node].position - building[panel.nodes[0]].position)).head<2>());
  double sum = area(outline);
  if (less_openings)
    for (const auto& opening : panel.openings) sum -= area(opening);
  return sum;
}

}  // namespace topple::structure
