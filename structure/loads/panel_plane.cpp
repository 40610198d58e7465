#include "panel_plane.h"

namespace topple::structure {

PanelPlane panel_plane(const Building& building, const Panel& panel) {
  PanelPlane plane;
  const Vec3 origin = building[panel.nodes[0]].position;
  for (std::size_t i = 0; i < 4; ++i)
    plane.corner[i] = (panel.axes * (building[panel.nodes[i]].position - origin)).head<2>();
  plane.openings = panel.openings;
  plane.axes = panel.axes;
  plane.normal = panel.axes.row(2).transpose();
  return plane;
}

int shorter_span(const PanelPlane& plane) {
  const auto middle = [&](std::size_t edge) { return Vec2((plane.corner[edge] + plane.corner[(edge + 1) % 4]) / 2); };
  return (middle(0) - middle(2)).norm() <= (middle(1) - middle(3)).norm() ? 0 : 1;
}

}  // namespace topple::structure
