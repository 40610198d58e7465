#pragma once
// The grid of both cell methods: columns and rows over a convex quadrilateral, spread bilinearly.
#include <array>

#include "topple/fracture/polygon.h"

namespace topple::fracture {

/// Columns and rows that bring the cells over an outline closest to the size `cell` (m), or those of `divisions` where
/// it is not 0. Throws UnfitSettings for more than can be of use.
[[nodiscard]] std::array<int, 2> cells_in_grid(const std::array<Vec2, 4>& outline, double cell,
                                               const std::array<int, 2>& divisions);

class Grid {
 public:
  Grid() = default;
  /// Columns and rows are those of cells_in_grid(). Throws std::invalid_argument when the outline is not convex and
  /// counter-clockwise or `cell` is not above 0.
  Grid(const std::array<Vec2, 4>& outline, double cell, const std::array<int, 2>& divisions);

  [[nodiscard]] int columns() const { return columns_; }
  [[nodiscard]] int rows() const { return rows_; }
  [[nodiscard]] const std::array<Vec2, 4>& outline() const { return outline_; }
  /// Grid coordinates (0 to columns, 0 to rows) to the panel.
  [[nodiscard]] Vec2 at(double column, double row) const;
  /// The cell of the regular grid at a point, or one near it: where a search begins.
  [[nodiscard]] std::array<int, 2> start(const Vec2& point) const;
  /// No two points of the panel whose grid coordinates differ by d are closer than d times this (m per cell).
  [[nodiscard]] double least_stretch() const { return least_stretch_; }
  /// Calls visit(column, row) for all cells of the ring at a distance of `ring` cells around one.
  template <class Visit>
  void each_in_ring(int column, int row, int ring, const Visit& visit) const {
    for (int dr = -ring; dr <= ring; ++dr)
      for (int dc = -ring; dc <= ring; dc += (dr == -ring || dr == ring ? 1 : 2 * ring)) {
        const int c = column + dc, r = row + dr;
        if (c >= 0 && c < columns_ && r >= 0 && r < rows_) visit(c, r);
      }
  }
  /// Calls visit(column, row) ring by ring around a cell, until all are seen or more(ring) is false.
  template <class More, class Visit>
  void each_outwards(int column, int row, const More& more, const Visit& visit) const {
    const int last = columns_ > rows_ ? columns_ : rows_;
    for (int ring = 0; ring < last && more(ring); ++ring) {
      if (ring == 0)
        visit(column, row);
      else
        each_in_ring(column, row, ring, visit);
    }
  }

 private:
  std::array<Vec2, 4> outline_{Vec2(0, 0), Vec2(1, 0), Vec2(1, 1), Vec2(0, 1)};
  int columns_ = 1, rows_ = 1;
  double least_stretch_ = 0;
};

}  // namespace topple::fracture
