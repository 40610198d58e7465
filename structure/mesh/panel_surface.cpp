#include "mesh/panel_surface.h"

#include <Eigen/LU>
#include <algorithm>

namespace topple::structure {

namespace {

template <class Vector>
Vector bilinear(const std::array<Vector, 4>& c, const Vec2& st) {
  const double s = st.x(), t = st.y();
  return (1 - s) * (1 - t) * c[0] + s * (1 - t) * c[1] + s * t * c[2] + (1 - s) * t * c[3];
}

}  // namespace

PanelSurface::PanelSurface(const Building& building, const Panel& panel) {
  for (std::size_t i = 0; i < 4; ++i) {
    corner_[i] = building[panel.nodes[i]].position;
    local_[i] = panel.axes.topRows<2>() * (corner_[i] - corner_[0]);
  }
  for (std::size_t i = 0; i < 4; ++i) size_ = std::max(size_, edge_length(i));
}

Vec3 PanelSurface::at(const Vec2& st) const { return bilinear(corner_, st); }

Vec2 PanelSurface::local(const Vec2& st) const { return bilinear(local_, st); }

Vec2 PanelSurface::parameters(const Vec2& local_place) const {
  Vec2 st(0.5, 0.5);
  // Newton's method converges from the middle for every convex quadrilateral; on a parallelogram in one step.
  constexpr int enough = 50;
  for (int i = 0; i < enough; ++i) {
    Eigen::Matrix2d slope;
    slope.col(0) = (1 - st.y()) * (local_[1] - local_[0]) + st.y() * (local_[2] - local_[3]);
    slope.col(1) = (1 - st.x()) * (local_[3] - local_[0]) + st.x() * (local_[2] - local_[1]);
    const Vec2 step = slope.inverse() * (local_place - local(st));
    st += step;
    constexpr double rounding = 1e-15;
    if (step.norm() <= rounding) break;
  }
  return st;
}

}  // namespace topple::structure
