#pragma once
// Regions of the triangulation as few convex polygons.
#include <span>
#include <utility>
#include <vector>

#include "topple/fracture/panel.h"
#include "triangulation.h"

namespace topple::fracture {

/// S. Hertel and K. Mehlhorn, "Fast triangulation of simple polygons" (1983): a side between two triangles is taken out
/// where both its ends stay convex. At most four times as many pieces as the best, and one where the region is convex.
/// A corner may lie inside the straight line by the tolerance. Keeps its memory from region to region.
class ConvexPieces {
 public:
  explicit ConvexPieces(const Triangulation& triangulation) : triangulation_(triangulation) {}
  /// Appends the given triangles, all of one label, as convex chunks; their order does not matter.
  void append(std::span<const int> triangles, bool hit, std::vector<Chunk>& chunks);

 private:
  static std::size_t index(int i) { return static_cast<unsigned>(i); }
  [[nodiscard]] int global(int local) const {
    return Triangulation::half(triangles_[index(Triangulation::triangle_of(local))], Triangulation::side_of(local));
  }
  [[nodiscard]] int corner(int local) const { return triangulation_.origin(global(local)); }
  [[nodiscard]] const Vec2& point(int local) const { return triangulation_.point(corner(local)); }
  [[nodiscard]] int twin_of(int local) const;
  [[nodiscard]] int find(int group);
  [[nodiscard]] bool convex(int before, int at, int after) const;
  void start(std::span<const int> triangles);
  void try_merge(int edge, int twin);
  [[nodiscard]] int number_at(int edge) const;

  const Triangulation& triangulation_;
  std::vector<int> triangles_;                ///< of the region, ascending; half-edges are numbered by places in it
  std::vector<int> local_of_;                 ///< of each triangle that lies in the region: its place there
  std::vector<int> twin_, next_, previous_;   ///< of each half-edge; the last two around its piece
  std::vector<int> group_;                    ///< of each triangle: itself or an earlier one of its piece
  std::vector<char> inner_;                   ///< of each half-edge: whether it was taken out
  std::vector<int> number_;                   ///< of each half-edge that was not: its place in the outline
  std::vector<int> chunk_of_;                 ///< of each triangle
  std::vector<std::size_t> corners_, faces_;  ///< of each chunk
};

}  // namespace topple::fracture
