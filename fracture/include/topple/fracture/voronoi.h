#pragma once
// Voronoi cells over a convex quadrilateral, from sites on a jittered grid.
#include <array>
#include <cstdint>
#include <memory>
#include <span>

#include "topple/fracture/polygon.h"

namespace topple::fracture {

class Grid;

/// Size, irregularity and seed of the sites.
struct VoronoiSettings {
  double cell = 0.5;                   ///< size of a grid cell, m
  double jitter = 1.0;                 ///< 0: sites at the cells' centres, 1: anywhere in their cells
  std::uint64_t seed = 1;              ///< of the sites' random places
  std::array<int, 2> divisions{0, 0};  ///< columns and rows; 0: as many as bring the cells closest to `cell`
};

/// One cell of the diagram. The label of an edge is the site on its other side, or -1 - k on edge k of the panel's
/// border.
struct VoronoiCell {
  Vec2 site;                ///< in the panel, m
  LabelledPolygon polygon;  ///< convex; neighbours along its edges
};

/// The panel's sites; cells are made when they are asked for, at a cost that does not depend on the panel's size.
class VoronoiGrid {
 public:
  /// `outline`: a convex quadrilateral, counter-clockwise. Throws std::invalid_argument when it is not, or a setting is
  /// out of range.
  VoronoiGrid(const std::array<Vec2, 4>& outline, const VoronoiSettings& settings);
  /// With chosen sites: the place of each in its grid cell, 0 to 1 along either way of the grid, by their numbers (row
  /// * columns() + column). `settings.jitter` and `seed` are not used. Throws as well when a place is missing or out of
  /// range.
  VoronoiGrid(const std::array<Vec2, 4>& outline, const VoronoiSettings& settings, std::span<const Vec2> places);

  /// Number of grid cells along the outline's first edge.
  [[nodiscard]] int columns() const;
  /// Number of grid cells across it.
  [[nodiscard]] int rows() const;
  /// Number of sites, one for each cell of the grid.
  [[nodiscard]] int size() const { return columns() * rows(); }
  /// Place of a site in the panel, m. The index is row * columns() + column.
  [[nodiscard]] const Vec2& site(int index) const { return sites_[static_cast<std::size_t>(index)]; }

  /// Exact: neighbours are taken ring by ring of the grid until the ring lies farther away than twice the cell's
  /// farthest vertex, when no farther site can cut it any more (the security radius). A fixed number of rings is not
  /// enough: cells that are longer than wide have neighbours up to seven rings away.
  [[nodiscard]] VoronoiCell cell(int index) const;
  /// Rings that the last call of this cell needs, for those who want to see why.
  [[nodiscard]] int rings(int index) const;

  /// The cell that holds a point of the panel: the one with the nearest site, the first of equals.
  [[nodiscard]] int nearest(const Vec2& point) const;
  /// All cells whose site lies within a distance of a point, in increasing order.
  [[nodiscard]] std::vector<int> within(const Vec2& point, double radius) const;

 private:
  VoronoiCell make(int index, int& rings) const;

  std::shared_ptr<const Grid> grid_;
  double jitter_ = 1;
  std::vector<Vec2> sites_;
};

}  // namespace topple::fracture
