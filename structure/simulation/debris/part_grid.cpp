#include "simulation/debris/part_grid.h"

#include <algorithm>
#include <cmath>

namespace topple::structure {

namespace {
/// Cells along the longest side at most; a bay or so for most buildings.
constexpr int most_cells = 64;
/// Smallest cell, m: smaller than most parts, larger than most gaps.
constexpr double smallest_cell = 4;
}  // namespace

PartGrid::PartGrid(const Building& building, const PartShapes& shapes) : building_(building), shapes_(shapes) {
  const std::size_t parts = part_count(building);
  for (std::size_t i = 0; i < parts; ++i)
    bounds_.add(shapes.bounds(part_of_number(building, static_cast<std::int64_t>(i))));
  if (parts == 0) bounds_.low = bounds_.high = Vec3::Zero();
  const Vec3 size = bounds_.high - bounds_.low;
  cell_ = std::max(smallest_cell, size.maxCoeff() / most_cells);
  for (std::size_t axis = 0; axis < 3; ++axis)
    counts_[axis] = 1 + static_cast<int>(size[static_cast<Eigen::Index>(axis)] / cell_);
  cells_.resize(static_cast<std::size_t>(counts_[0]) * static_cast<std::size_t>(counts_[1] * counts_[2]));
  for (std::size_t i = 0; i < parts; ++i) {
    const Range range = cells_of(shapes.bounds(part_of_number(building, static_cast<std::int64_t>(i))));
    visit(range, [&](std::size_t cell) { cells_[cell].push_back(static_cast<std::int32_t>(i)); });
  }
}

PartGrid::Range PartGrid::cells_of(const Bounds& box) const {
  Range range;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<Eigen::Index>(axis);
    const double last = counts_[axis] - 1;
    range.first[axis] = static_cast<int>(std::clamp(std::floor((box.low[a] - bounds_.low[a]) / cell_), 0.0, last));
    range.last[axis] = static_cast<int>(std::clamp(std::floor((box.high[a] - bounds_.low[a]) / cell_), 0.0, last));
  }
  return range;
}

template <class Visit>
void PartGrid::visit(const Range& range, const Visit& visit) const {
  for (int i = range.first[0]; i <= range.last[0]; ++i)
    for (int j = range.first[1]; j <= range.last[1]; ++j)
      for (int k = range.first[2]; k <= range.last[2]; ++k)
        visit(static_cast<std::size_t>((i * counts_[1] + j) * counts_[2] + k));
}

std::vector<Part> PartGrid::near(const Bounds& box, std::span<const char> passed_over) const {
  if (!bounds_.meets(box)) return {};
  std::vector<std::int32_t> found;
  visit(cells_of(box), [&](std::size_t cell) {
    for (const std::int32_t number : cells_[cell])
      if (passed_over.empty() || passed_over[static_cast<std::size_t>(number)] == 0) found.push_back(number);
  });
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  std::vector<Part> parts;
  for (const std::int32_t number : found) {
    const Part part = part_of_number(building_, number);
    if (shapes_.bounds(part).meets(box)) parts.push_back(part);
  }
  return parts;
}

}  // namespace topple::structure
