#pragma once
// Triangles in the plane by their half-edges: how they hang together, and nothing of where it would be good to flip or
// split them. Every triangle carries a label (what it is part of) and every edge may be fixed (a border between
// labels).
#include <cstdint>
#include <utility>
#include <vector>

#include "half_edge_numbers.h"
#include "topple/fracture/polygon.h"

namespace topple::fracture {

class HalfEdges : public HalfEdgeNumbers {
 public:
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
  [[nodiscard]] double doubled_area(int triangle) const;
  /// The half-edge from one vertex to another, or `none`.
  [[nodiscard]] int find_edge(int from, int to) const;
  /// Calls visit(edge) for the half-edge of each triangle at a vertex that leaves it, until one returns true; whether
  /// one did.
  template <class Visit>
  bool any_around(int vertex, const Visit& visit) const;
  /// All triangles at a vertex.
  [[nodiscard]] std::vector<int> star(int vertex) const;
  /// All connected triangles for which `inside` holds, from the corners of `chain` on, in the order in which they are
  /// reached.
  template <class Inside>
  std::vector<int> collect(const std::vector<int>& chain, const Inside& inside);

  void set_label(int triangle, int label);
  /// Fixes an edge, as one that lies on this (`none`: a cut).
  void fix(int edge, int tag) { set_fixed(edge, true, tag); }
  /// Frees the triangle's sides that separate nothing, fixes those that do.
  void settle_sides(int triangle);
  void settle_side(int edge);

  /// Triangles made, changed or removed since the list was last cleared, each once.
  [[nodiscard]] const std::vector<int>& touched() const { return touched_; }
  void clear_touched();
  /// Checks the whole structure: twins, orientation, labels against fixed edges. For tests.
  [[nodiscard]] bool valid() const;

  template <class Archive>
  void serialize(Archive& archive) {
    auto& [points, some_edge, edges, labels, free_triangles, free_vertices, touched, is_touched, visited, visit] =
        *this;
    archive(points, some_edge, edges, labels, free_triangles, free_vertices, touched, is_touched);
    // The last two: each search begins with nothing visited.
  }

 protected:
  /// Two triangles with the label 0.
  HalfEdges(const Vec2& lower, const Vec2& upper);
  [[nodiscard]] const Vec2& start(int edge) const { return point(origin(edge)); }
  [[nodiscard]] const Vec2& end(int edge) const { return point(target(edge)); }

  void set_fixed(int edge, bool fixed, int tag);
  /// The other diagonal of the two triangles at a half-edge.
  void flip(int edge);
  /// A new vertex in a triangle, which becomes three.
  int split_triangle(int triangle, const Vec2& point);
  /// A new vertex on an edge, whose two triangles become four; its parts are fixed as it was.
  int split_edge(int edge, const Vec2& point);
  /// Takes away a vertex at which three triangles meet; they become one, which is returned. `none`, and nothing
  /// changes, when the corners around it do not go counter-clockwise.
  int merge_around(int vertex);
  /// Appends the triangles on the left of a closed chain of half-edges, in the order in which they are reached.
  void fill(const std::vector<int>& loop, std::vector<int>& triangles);

 private:
  static constexpr int dead = -1;
  struct alignas(16) HalfEdge {
    int origin = none;
    int twin = none;
    int tag = none;
    int flags = 0;
  };
  template <class Archive>
  friend void serialize(Archive& archive, HalfEdge& edge) {
    auto& [origin, twin, tag, flags] = edge;
    archive(origin, twin, tag, flags);
  }
  static constexpr int is_fixed = 1, on_loop = 2;  ///< flags; the second while the inside of a loop is searched

  int new_vertex(const Vec2& point);
  int new_triangle();
  void make(int triangle, int a, int b, int c, int label);
  void attach(int edge, const HalfEdge& side);
  void join(int edge, int other);
  void touch(int triangle) {
    if (std::exchange(is_touched_[index(triangle)], 1) == 0) touched_.push_back(triangle);
  }
  /// Begins a search: nothing is visited.
  void leave_all();
  /// True for the first time since then.
  [[nodiscard]] bool visit(int triangle) { return std::exchange(visited_[index(triangle)], visit_) != visit_; }

  std::vector<Vec2> points_;
  std::vector<int> some_edge_;   ///< of each vertex: one half-edge that leaves it
  std::vector<HalfEdge> edges_;  ///< four of each triangle, the last without use
  std::vector<int> labels_;
  std::vector<int> free_triangles_, free_vertices_, touched_;
  std::vector<char> is_touched_;
  std::vector<std::uint32_t> visited_;  ///< of each triangle: the last search that saw it
  std::uint32_t visit_ = 0;
};

template <class Visit>
bool HalfEdges::any_around(int vertex, const Visit& visit) const {
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

template <class Inside>
std::vector<int> HalfEdges::collect(const std::vector<int>& chain, const Inside& inside) {
  std::vector<int> found;
  leave_all();
  const auto collect_once = [&](int triangle) {
    if (visit(triangle) && inside(triangle)) found.push_back(triangle);
  };
  for (const int vertex : chain)
    for (const int triangle : star(vertex)) collect_once(triangle);
  for (std::size_t i = 0; i < found.size(); ++i)
    for (const int edge : sides(found[i]))
      if (twin(edge) != none) collect_once(triangle_of(twin(edge)));
  return found;
}

}  // namespace topple::fracture
