#pragma once
// Voronoi cells over a convex quadrilateral, from sites on a jittered grid.
#include <array>
#include <cstdint>

#include "topple/fracture/polygon.h"

namespace topple::fracture {

struct VoronoiSettings {
  double cell = 0.5;    ///< size of a grid cell, m
  double jitter = 1.0;  ///< 0: sites at the cells' centres, 1: anywhere in their cells
  std::uint64_t seed = 1;
};

/// One cell of the diagram. The label of an edge is the site on its other side, or -1 - k on edge k of the panel's
/// border.
struct VoronoiCell {
  Vec2 site;
  LabelledPolygon polygon;
};

/// The panel's sites; cells are made when they are asked for, at a cost that does not depend on the panel's size.
class VoronoiGrid {
 public:
  /// `outline`: a convex quadrilateral, counter-clockwise. Throws std::invalid_argument when it is not, or a setting is
  /// out of range.
  VoronoiGrid(const std::array<Vec2, 4>& outline, const VoronoiSettings& settings);

  [[nodiscard]] int columns() const { return columns_; }
  [[nodiscard]] int rows() const { return rows_; }
  [[nodiscard]] int size() const { return columns_ * rows_; }
  [[nodiscard]] const Vec2& site(int index) const { return sites_[static_cast<std::size_t>(index)]; }

  /// Exact: neighbours are taken ring by ring of the grid until the ring lies farther away than twice the cell's
  /// farthest vertex, when no farther site can cut it any more (the security radius). A fixed number of rings is not
  /// enough: cells that are longer than wide have neighbours five rings away and more.
  [[nodiscard]] VoronoiCell cell(int index) const;
  /// Rings that the last call of this cell needs, for those who want to see why.
  [[nodiscard]] int rings(int index) const;

 private:
  VoronoiCell make(int index, int& rings) const;

  Polygon outline_;
  int columns_ = 1, rows_ = 1;
  double jitter_ = 1;
  double least_stretch_ = 0;  ///< lower bound of distance per cell of the grid
  std::vector<Vec2> sites_;
};

}  // namespace topple::fracture
