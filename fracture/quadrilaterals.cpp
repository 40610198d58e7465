#include "topple/fracture/quadrilaterals.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "grid.h"
#include "predicates.h"
#include "random.h"

namespace topple::fracture {

QuadrilateralGrid::QuadrilateralGrid(const std::array<Vec2, 4>& outline, const QuadrilateralSettings& settings)
    : grid_(std::make_shared<const Grid>(outline, settings.cell, settings.divisions)), jitter_(settings.jitter) {
  if (!(jitter_ >= 0 && jitter_ <= 1)) throw std::invalid_argument("jitter must be from 0 to 1");
  Random random(settings.seed);
  for (int row = 0; row <= rows(); ++row)
    for (int column = 0; column <= columns(); ++column) {
      // Both numbers are drawn for every point, so that one does not depend on where another lies.
      const double du = jitter_ * (random.unit() - 0.5), dv = jitter_ * (random.unit() - 0.5);
      const bool side = column == 0 || column == columns(), end = row == 0 || row == rows();
      if (side && end)  // the corner itself, not what rounding makes of it
        points_.push_back(outline[row == 0 ? (column == 0 ? 0u : 1u) : (column == 0 ? 3u : 2u)]);
      else
        points_.push_back(grid_->at(column + (side ? 0 : du), row + (end ? 0 : dv)));
    }
}

int QuadrilateralGrid::columns() const { return grid_->columns(); }
int QuadrilateralGrid::rows() const { return grid_->rows(); }

const Vec2& QuadrilateralGrid::point(int column, int row) const {
  return points_[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns() + 1) +
                 static_cast<std::size_t>(column)];
}

Polygon QuadrilateralGrid::cell(int index) const {
  const int column = index % columns(), row = index / columns();
  return {point(column, row), point(column + 1, row), point(column + 1, row + 1), point(column, row + 1)};
}

int QuadrilateralGrid::holding(const Vec2& position) const {
  const auto [column, row] = grid_->start(position);
  const double off = (grid_->at(column + 0.5, row + 0.5) - position).norm();
  // A point of a cell is less than one and a half cells from its middle, in either direction of the grid.
  const double margin = (1 + jitter_) / 2 + 0.5;
  int found = -1;
  grid_->each_outwards(
      column, row, [&](int ring) { return (ring - margin) * grid_->least_stretch() <= off; },
      [&](int c, int r) {
        const int index = r * columns() + c;
        if (encloses(cell(index), position) && (found < 0 || index < found)) found = index;
      });
  return found;
}

std::vector<int> QuadrilateralGrid::within(const Vec2& position, double radius) const {
  const auto [column, row] = grid_->start(position);
  const double off = (grid_->at(column + 0.5, row + 0.5) - position).norm();
  const double margin = (1 + jitter_) / 2 + 0.5;
  std::vector<int> found;
  grid_->each_outwards(
      column, row, [&](int ring) { return (ring - margin) * grid_->least_stretch() - off <= radius; },
      [&](int c, int r) {
        const int index = r * columns() + c;
        const Polygon corners = cell(index);
        bool near = encloses(corners, position);
        for (std::size_t i = 0; i < 4 && !near; ++i)
          near = distance_to_segment(position, corners[i], corners[(i + 1) % 4]) <= radius;
        if (near) found.push_back(index);
      });
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace topple::fracture
