#pragma once
// Quadrilateral cells between the points of a jittered grid over a convex quadrilateral.
//
// The cells carry the damage, not the points: with flags on points a cell is drawn when its points are there, so that
// two lost neighbours take the strip between them along, or leave it without width. Inner points move by up to half a
// cell in the grid's directions, those of the border along it, corners stay: the cells tile the panel at any jitter,
// but above a jitter of about a half they need not be convex.
#include <array>
#include <cstdint>
#include <memory>

#include "topple/fracture/polygon.h"

namespace topple::fracture {

class Grid;

/// Size, irregularity and seed of a grid of quadrilaterals.
struct QuadrilateralSettings {
  double cell = 0.5;                   ///< size of a cell, m
  double jitter = 0.5;                 ///< 0: a regular grid, 1: points move by up to half a cell
  std::uint64_t seed = 1;              ///< of the points' random offsets
  std::array<int, 2> divisions{0, 0};  ///< columns and rows; 0: as many as bring the cells closest to `cell`
};

/// The cells of one panel.
class QuadrilateralGrid {
 public:
  /// `outline`: a convex quadrilateral, counter-clockwise. Throws std::invalid_argument when it is not, or a setting is
  /// out of range.
  QuadrilateralGrid(const std::array<Vec2, 4>& outline, const QuadrilateralSettings& settings);

  /// Number of cells along the outline's first edge.
  [[nodiscard]] int columns() const;
  /// Number of cells across it.
  [[nodiscard]] int rows() const;
  /// Number of cells.
  [[nodiscard]] int size() const { return columns() * rows(); }
  /// Point of the grid, column from 0 to columns() and row from 0 to rows(), both included.
  [[nodiscard]] const Vec2& point(int column, int row) const;
  /// The four corners of a cell, counter-clockwise; its number is row * columns() + column.
  [[nodiscard]] Polygon cell(int index) const;

  /// The cell that holds a point, decided exactly; the first of those that share it. -1 outside the panel.
  [[nodiscard]] int holding(const Vec2& point) const;
  /// All cells of which any point lies within a distance of a point, in increasing order.
  [[nodiscard]] std::vector<int> within(const Vec2& point, double radius) const;

 private:
  std::shared_ptr<const Grid> grid_;
  double jitter_ = 0.5;
  std::vector<Vec2> points_;
};

}  // namespace topple::fracture
