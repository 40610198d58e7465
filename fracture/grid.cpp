#include "grid.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "cross.h"
#include "topple/fracture/unfit_settings.h"

namespace topple::fracture {

namespace {

/// Newton's steps for the inverse of the bilinear map: enough for a start, since a search follows.
constexpr int kNewtonSteps = 4;

}  // namespace

std::array<int, 2> cells_in_grid(const std::array<Vec2, 4>& outline, double cell, const std::array<int, 2>& divisions) {
  constexpr int most_in_row = 100'000;
  constexpr double most = 1e6;
  constexpr const char* refusal =
      "cell is too small for the panel; accepted: at most 100000 cells in a row and 1000000 in all";
  const auto length = [&](std::size_t edge) { return (outline[(edge + 1) % 4] - outline[edge]).norm(); };
  const auto cells = [&](int given, double size) {
    if (given > 0) return given;
    if (!(size / cell < most_in_row)) throw UnfitSettings(refusal);
    return std::max(1, static_cast<int>(std::lround(size / cell)));
  };
  const std::array<int, 2> count{cells(divisions[0], (length(0) + length(2)) / 2),
                                 cells(divisions[1], (length(1) + length(3)) / 2)};
  if (static_cast<double>(count[0]) * count[1] > most) throw UnfitSettings(refusal);
  return count;
}

Grid::Grid(const std::array<Vec2, 4>& outline, double cell, const std::array<int, 2>& divisions) : outline_(outline) {
  if (!(cell > 0)) throw std::invalid_argument("cell must be above 0");
  for (std::size_t i = 0; i < 4; ++i)
    if (!(cross(outline[(i + 1) % 4] - outline[i], outline[(i + 2) % 4] - outline[(i + 1) % 4]) > 0))
      throw std::invalid_argument("the outline must be convex and go counter-clockwise");
  const std::array<int, 2> count = cells_in_grid(outline, cell, divisions);
  columns_ = count[0];
  rows_ = count[1];

  // The map from the grid to the panel stretches every direction by at least min det J / max |J|: its determinant is
  // linear and its largest singular value convex, so both bounds are found at the corners. The panel is convex, so a
  // straight line in it has a path in the grid, and no shorter one than this bound allows.
  double least_area = INFINITY, greatest_stretch = 0;
  for (std::size_t corner = 0; corner < 4; ++corner) {
    const bool right = corner == 1 || corner == 2, top = corner >= 2;
    const Vec2 along_u = (top ? outline[2] - outline[3] : outline[1] - outline[0]) / columns_;
    const Vec2 along_v = (right ? outline[2] - outline[1] : outline[3] - outline[0]) / rows_;
    least_area = std::min(least_area, cross(along_u, along_v));
    // The larger eigenvalue of J^T J is its square.
    const double mean = (along_u.squaredNorm() + along_v.squaredNorm()) / 2;
    const double half_gap = (along_u.squaredNorm() - along_v.squaredNorm()) / 2;
    greatest_stretch = std::max(greatest_stretch, std::sqrt(mean + std::hypot(half_gap, along_u.dot(along_v))));
  }
  constexpr double rounding = 1 - 1e-12;
  least_stretch_ = rounding * least_area / greatest_stretch;
}

Vec2 Grid::at(double column, double row) const {
  const double u = column / columns_, v = row / rows_;
  return (1 - v) * ((1 - u) * outline_[0] + u * outline_[1]) + v * ((1 - u) * outline_[3] + u * outline_[2]);
}

std::array<int, 2> Grid::start(const Vec2& point) const {
  Vec2 lower = outline_[0], upper = outline_[0];
  for (const Vec2& corner : outline_) {
    lower = lower.cwiseMin(corner);
    upper = upper.cwiseMax(corner);
  }
  const Vec2 near = point.cwiseMax(lower).cwiseMin(upper);
  double u = 0.5, v = 0.5;
  for (int step = 0; step < kNewtonSteps; ++step) {
    const Vec2 off = near - at(u * columns_, v * rows_);
    const Vec2 along_u = (1 - v) * (outline_[1] - outline_[0]) + v * (outline_[2] - outline_[3]);
    const Vec2 along_v = (1 - u) * (outline_[3] - outline_[0]) + u * (outline_[2] - outline_[1]);
    const double area = cross(along_u, along_v);
    u = std::clamp(u + cross(off, along_v) / area, 0.0, 1.0);
    v = std::clamp(v + cross(along_u, off) / area, 0.0, 1.0);
  }
  return {std::min(columns_ - 1, static_cast<int>(u * columns_)), std::min(rows_ - 1, static_cast<int>(v * rows_))};
}

}  // namespace topple::fracture
