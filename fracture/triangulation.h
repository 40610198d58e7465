#pragma once
// A constrained Delaunay triangulation of a box that is cut again and again: the ground on which a panel breaks.
//
// Points and segments are inserted one by one by S. Sloan's method (point location by walking, Lawson's flips, segments
// by flipping what they cross), so that the cost of a cut grows with what it touches. All decisions use the exact
// orientation, so that the triangles tile the box whatever comes in; crossing points are rounded, which moves an old
// edge by a rounding error and no more. What would come closer than `tolerance` to something that is there is joined
// with it: a point with a point or with a fixed edge, a segment with the points it passes. So there are no slivers.
#include <utility>
#include <vector>

#include "half_edges.h"
#include "predicates.h"

namespace topple::fracture {

class Triangulation : public HalfEdges {
 public:
  /// An empty box of two triangles with the label 0. Everything inserted must lie inside, and `tolerance` away from its
  /// border.
  Triangulation(const Vec2& lower, const Vec2& upper, double tolerance);

  /// The vertex that now stands for a point: a new one, or what was within the tolerance.
  int add_point(const Vec2& point);
  /// Fixes a chain of edges from one vertex to another, which leaves the straight line by about the tolerance at most.
  /// Appends the vertices on its way, `to` included, to `chain`.
  void add_segment(int from, int to, std::vector<int>& chain);
  /// The triangles on the left of a closed chain of edges that goes counter-clockwise and passes no vertex twice, and
  /// its edges; false, and nothing, when the chain is not such a one.
  bool enclose(const std::vector<int>& chain, std::vector<int>& triangles, std::vector<int>& edges);
  /// Removes a vertex around which nothing is fixed; false when it has to stay (a corner of the box).
  bool remove_vertex(int vertex);
  /// The triangle that holds a point of the box.
  [[nodiscard]] int locate(const Vec2& point) const;
  /// Segments that could not be finished within the allowed steps: 0 unless something is wrong.
  [[nodiscard]] int unfinished() const { return unfinished_; }
  [[nodiscard]] double tolerance() const { return tolerance_; }

  /// The tolerance is given; lists kept for their memory are empty between two calls.
  template <class Archive>
  void serialize(Archive& archive) {
    HalfEdges::serialize(archive);
    archive(unfinished_, hint_);
  }

 private:
  /// Whether the two triangles at a half-edge are a convex quadrilateral.
  [[nodiscard]] bool may_flip(int edge) const {
    const int other = twin(edge);
    if (other == none) return false;
    const Vec2 &a = start(edge), &b = end(edge), &c = point(apex(edge)), &d = point(apex(other));
    return orientation(a, d, c) > 0 && orientation(d, b, c) > 0;
  }
  void legalise_open();
  void legalise_around(int vertex);
  int split_fixed(int edge, const Vec2& point);
  template <class Visit>
  void collect_near(int home, const Visit& visit);
  [[nodiscard]] int first_crossed(int from, int to, int& on_the_way) const;
  [[nodiscard]] bool passes(int vertex, int from, int to) const;
  int split_crossing(int edge, int from, int to);
  int advance(int from, int to);
  int obstacle(int from, int to);
  void connect(int from, int to);

  double tolerance_;
  int unfinished_ = 0;
  mutable int hint_ = 0;
  // Kept for their memory: of collect_near; half-edges that Lawson's flips have yet to look at; ends of the edges that
  // a segment crosses, and of those made in their place.
  std::vector<int> near_, open_;
  std::vector<std::pair<int, int>> crossed_, made_;
};

template <class Visit>
void Triangulation::collect_near(int home, const Visit& visit) {
  std::vector<int>& open = near_;
  open.assign(1, home);
  for (std::size_t i = 0; i < open.size(); ++i)
    for (const int edge : sides(open[i])) {
      if (!visit(edge) || twin(edge) == none) continue;
      const int beyond = triangle_of(twin(edge));
      bool known = false;
      for (const int triangle : open) known = known || triangle == beyond;
      if (!known) open.push_back(beyond);
    }
}

}  // namespace topple::fracture
