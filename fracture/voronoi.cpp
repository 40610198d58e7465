#include "topple/fracture/voronoi.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "grid.h"
#include "random.h"

namespace topple::fracture {

VoronoiGrid::VoronoiGrid(const std::array<Vec2, 4>& outline, const VoronoiSettings& settings)
    : grid_(std::make_shared<const Grid>(outline, settings.cell, settings.divisions)), jitter_(settings.jitter) {
  if (!(jitter_ >= 0 && jitter_ <= 1)) throw std::invalid_argument("jitter must be from 0 to 1");
  Random random(settings.seed);
  sites_.reserve(static_cast<std::size_t>(size()));
  for (int row = 0; row < rows(); ++row)
    for (int column = 0; column < columns(); ++column) {
      const double u = column + 0.5 + jitter_ * (random.unit() - 0.5);
      const double v = row + 0.5 + jitter_ * (random.unit() - 0.5);
      sites_.push_back(grid_->at(u, v));
    }
}

VoronoiGrid::VoronoiGrid(const std::array<Vec2, 4>& outline, const VoronoiSettings& settings,
                         std::span<const Vec2> places)
    : grid_(std::make_shared<const Grid>(outline, settings.cell, settings.divisions)) {
  if (places.size() != static_cast<std::size_t>(size()))
    throw std::invalid_argument("found " + std::to_string(places.size()) +
                                " places of sites; accepted: one for each of " + std::to_string(size()) + " cells");
  sites_.reserve(places.size());
  for (const Vec2& place : places) {
    if (!(place.minCoeff() >= 0 && place.maxCoeff() <= 1))
      throw std::invalid_argument("the place of a site in its cell must be from 0 to 1");
    const int index = static_cast<int>(sites_.size());
    sites_.push_back(grid_->at(index % columns() + place.x(), index / columns() + place.y()));
  }
}

int VoronoiGrid::columns() const { return grid_->columns(); }
int VoronoiGrid::rows() const { return grid_->rows(); }

VoronoiCell VoronoiGrid::make(int index, int& ring) const {
  const auto& outline = grid_->outline();
  constexpr std::size_t usual = 16;  // more corners than nearly all cells have
  VoronoiCell cell{site(index), {}};
  cell.polygon.vertices.reserve(usual);
  cell.polygon.labels.reserve(usual);
  cell.polygon.vertices.assign(outline.begin(), outline.end());
  cell.polygon.labels.assign({-1, -2, -3, -4});
  const auto farthest2 = [&] {
    double most = 0;
    for (const Vec2& vertex : cell.polygon.vertices) most = std::max(most, (vertex - cell.site).squaredNorm());
    return most;
  };
  const int column = index % columns(), row = index / columns();
  const int farthest_ring = std::max(columns(), rows());
  double reach2 = farthest2();  // the square of the distance to the cell's farthest vertex
  for (ring = 1; ring < farthest_ring; ++ring) {
    if ((ring - jitter_) * grid_->least_stretch() > 2 * std::sqrt(reach2)) break;
    grid_->each_in_ring(column, row, ring, [&](int c, int r) {
      const int other = r * columns() + c;
      const Vec2 away = site(other) - cell.site;
      if (away.squaredNorm() > 4 * reach2) return;  // half way to it lies beyond all of the cell
      const bool cut = clip(cell.polygon, cell.site + away / 2, away, other);
      if (cut && ring > 1) reach2 = farthest2();  // the first ring shapes the cell: none of it can be left out
    });
    if (ring == 1) reach2 = farthest2();
  }
  return cell;
}

VoronoiCell VoronoiGrid::cell(int index) const {
  int unused = 0;
  return make(index, unused);
}

int VoronoiGrid::rings(int index) const {
  int ring = 0;
  (void)make(index, ring);
  return ring - 1;
}

int VoronoiGrid::nearest(const Vec2& point) const {
  const auto [column, row] = grid_->start(point);
  const double off = (site(row * columns() + column) - point).norm();
  double least = INFINITY;
  int found = -1;
  grid_->each_outwards(
      column, row, [&](int ring) { return (ring - jitter_) * grid_->least_stretch() - off <= least; },
      [&](int c, int r) {
        const int index = r * columns() + c;
        const double distance = (site(index) - point).norm();
        if (distance < least || (distance == least && index < found)) {
          least = distance;
          found = index;
        }
      });
  return found;
}

std::vector<int> VoronoiGrid::within(const Vec2& point, double radius) const {
  const auto [column, row] = grid_->start(point);
  const double off = (site(row * columns() + column) - point).norm();
  std::vector<int> found;
  grid_->each_outwards(
      column, row, [&](int ring) { return (ring - jitter_) * grid_->least_stretch() - off <= radius; },
      [&](int c, int r) {
        const int index = r * columns() + c;
        if ((site(index) - point).norm() <= radius) found.push_back(index);
      });
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace topple::fracture
