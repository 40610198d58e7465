#pragma once
// A constrained Delaunay triangulation of a box that is cut again and again: the ground on which a panel breaks.
//
// Every triangle carries a label (what it is part of) and every edge may be fixed (a border between labels). Points and
// segments are inserted one by one by S. Sloan's method (point location by walking, Lawson's flips, segments by
// flipping what they cross), so that the cost of a cut grows with what it touches. All decisions use the exact
// orientation, so that the triangles tile the box whatever comes in; crossing points are rounded, which moves an old
// edge by a rounding error and no more. What would come closer than `tolerance` to something that is there is joined
// with it: a point with a point or with a fixed edge, a segment with the points it passes. So there are no slivers.
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "predicates.h"
#include "topple/fracture/polygon.h"

namespace topple::fracture {

class Triangulation {
 public:
  static constexpr int none = -1;
  /// Number of a half-edge: side i (0 to 2) of a triangle runs from corner i to corner i + 1, the triangle on its left.
  /// Every fourth number stands for nothing, so that shifts take the place of divisions.
  [[nodiscard]] static constexpr int half(int triangle, int side) { return 4 * triangle + side; }
  [[nodiscard]] static constexpr int triangle_of(int edge) { return edge >> 2; }
  [[nodiscard]] static constexpr int side_of(int edge) { return edge & 3; }
  [[nodiscard]] static constexpr std::array<int, 3> sides(int triangle) {
    return {half(triangle, 0), half(triangle, 1), half(triangle, 2)};
  }

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
  /// All connected triangles for which `inside` holds, from the corners of `chain` on, in the order in which they are
  /// reached.
  template <class Inside>
  std::vector<int> collect(const std::vector<int>& chain, const Inside& inside);

  void set_label(int triangle, int label);
  /// Frees the triangle's sides that separate nothing, fixes those that do.
  void settle_sides(int triangle);
  void settle_side(int edge);
  /// Removes a vertex around which nothing is fixed; false when it has to stay (a corner of the box).
  bool remove_vertex(int vertex);

  [[nodiscard]] const Vec2& point(int vertex) const { return points_[index(vertex)]; }
  [[nodiscard]] int vertex_slots() const { return static_cast<int>(points_.size()); }
  [[nodiscard]] int triangle_slots() const { return static_cast<int>(labels_.size()); }
  [[nodiscard]] bool alive(int triangle) const { return labels_[index(triangle)] != dead; }
  [[nodiscard]] int label(int triangle) const { return labels_[index(triangle)]; }
  [[nodiscard]] int origin(int edge) const { return edges_[index(edge)].origin; }
  [[nodiscard]] int target(int edge) const { return origin(next(edge)); }
  [[nodiscard]] int apex(int edge) const { return origin(previous(edge)); }
  [[nodiscard]] int twin(int edge) const { return edges_[index(edge)].twin; }
  [[nodiscard]] bool fixed(int edge) const { return (edges_[index(edge)].flags & is_fixed) != 0; }
  /// What a fixed edge lies on (`none` for a cut); set once, inherited by its parts.
  [[nodiscard]] int tag(int edge) const { return edges_[index(edge)].tag; }
  void set_tag(int edge, int tag);
  [[nodiscard]] static int next(int edge) { return (edge & 3) == 2 ? edge - 2 : edge + 1; }
  [[nodiscard]] static int previous(int edge) { return (edge & 3) == 0 ? edge + 2 : edge - 1; }
  [[nodiscard]] double doubled_area(int triangle) const;
  /// The triangle that holds a point of the box.
  [[nodiscard]] int locate(const Vec2& point) const;
  /// The half-edge from one vertex to another, or `none`.
  [[nodiscard]] int find_edge(int from, int to) const;
  /// Calls visit(edge) for the half-edge of each triangle at a vertex that leaves it, until one returns true; whether
  /// one did.
  template <class Visit>
  bool any_around(int vertex, const Visit& visit) const;
  /// All triangles at a vertex.
  [[nodiscard]] std::vector<int> star(int vertex) const;

  /// Triangles made, changed or removed since the list was last cleared, each once.
  [[nodiscard]] const std::vector<int>& touched() const { return touched_; }
  void clear_touched();
  /// Segments that could not be finished within the allowed steps: 0 unless something is wrong.
  [[nodiscard]] int unfinished() const { return unfinished_; }
  [[nodiscard]] double tolerance() const { return tolerance_; }
  /// Checks the whole structure: twins, orientation, labels against fixed edges. For tests.
  [[nodiscard]] bool valid() const;

 private:
  static constexpr int dead = -1;
  struct alignas(16) HalfEdge {
    int origin = none;
    int twin = none;
    int tag = none;
    int flags = 0;
  };
  static constexpr int is_fixed = 1, on_loop = 2;  ///< flags; the second while the inside of a loop is searched
  static std::size_t index(int i) { return static_cast<unsigned>(i); }
  [[nodiscard]] const Vec2& start(int edge) const { return point(origin(edge)); }
  [[nodiscard]] const Vec2& end(int edge) const { return point(target(edge)); }

  int new_vertex(const Vec2& point);
  int new_triangle();
  void make(int triangle, int a, int b, int c, int label);
  void attach(int edge, const HalfEdge& side);
  void join(int edge, int other);
  void fix(int edge, int tag);
  void touch(int triangle) {
    if (std::exchange(is_touched_[index(triangle)], 1) == 0) touched_.push_back(triangle);
  }

  void set_fixed(int edge, bool fixed, int tag);
  void flip(int edge);
  /// Whether the two triangles at a half-edge are a convex quadrilateral.
  [[nodiscard]] bool may_flip(int edge) const {
    const int other = twin(edge);
    if (other == none) return false;
    const Vec2 &a = start(edge), &b = end(edge), &c = point(apex(edge)), &d = point(apex(other));
    return orientation(a, d, c) > 0 && orientation(d, b, c) > 0;
  }
  void legalise_open();
  void legalise_around(int vertex);
  int insert_inside(int triangle, const Vec2& point);
  int split_at(int edge, const Vec2& point);
  int split_fixed(int edge, const Vec2& point);
  template <class Visit>
  void collect_near(int home, const Visit& visit);
  [[nodiscard]] int first_crossed(int from, int to, int& on_the_way) const;
  [[nodiscard]] bool passes(int vertex, int from, int to) const;
  int split_crossing(int edge, int from, int to);
  int advance(int from, int to);
  int obstacle(int from, int to);
  void connect(int from, int to);

  std::vector<Vec2> points_;
  std::vector<int> some_edge_;   ///< of each vertex: one half-edge that leaves it
  std::vector<HalfEdge> edges_;  ///< four of each triangle, the last without use
  std::vector<int> labels_;
  std::vector<int> free_triangles_, free_vertices_, touched_;
  std::vector<char> is_touched_;
  std::vector<std::uint32_t> visited_;  ///< of each triangle: the last search that saw it
  std::uint32_t visit_ = 0;
  double tolerance_;
  int unfinished_ = 0;
  mutable int hint_ = 0;
  // Kept for their memory: of collect_near; half-edges that Lawson's flips have yet to look at; ends of the edges that
  // a segment crosses, and of those made in their place.
  std::vector<int> near_, open_;
  std::vector<std::pair<int, int>> crossed_, made_;
};

template <class Visit>
bool Triangulation::any_around(int vertex, const Visit& visit) const {
  const int first = some_edge_[index(vertex)];
  int edge = first;
  do {
    if (visit(edge)) return true;
    edge = twin(previous(edge));
  } while (edge != none && edge != first);
  if (edge != none) return false;
  // A corner of the box: the other way round as well.
  for (edge = twin(first); edge != none; edge = twin(edge)) {
    edge = next(edge);
    if (visit(edge)) return true;
  }
  return false;
}

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

template <class Inside>
std::vector<int> Triangulation::collect(const std::vector<int>& chain, const Inside& inside) {
  std::vector<int> found;
  ++visit_;
  visited_.resize(labels_.size(), 0);
  const auto take = [&](int triangle) {
    if (visited_[index(triangle)] == visit_) return;
    visited_[index(triangle)] = visit_;
    if (inside(triangle)) found.push_back(triangle);
  };
  for (const int vertex : chain)
    for (const int triangle : star(vertex)) take(triangle);
  for (std::size_t i = 0; i < found.size(); ++i)
    for (const int edge : sides(found[i]))
      if (twin(edge) != none) take(triangle_of(twin(edge)));
  return found;
}

}  // namespace topple::fracture
