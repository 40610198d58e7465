#include "half_edges.h"

#include "predicates.h"

namespace topple::fracture {

HalfEdges::HalfEdges(const Vec2& lower, const Vec2& upper) {
  for (const Vec2& corner : {lower, Vec2(upper.x(), lower.y()), upper, Vec2(lower.x(), upper.y())}) new_vertex(corner);
  const int first = new_triangle(), second = new_triangle();
  make(first, 0, 1, 2, 0);
  make(second, 0, 2, 3, 0);
  join(half(first, 2), half(second, 0));
}

int HalfEdges::new_vertex(const Vec2& point) {
  if (!free_vertices_.empty()) {
    const int vertex = free_vertices_.back();
    free_vertices_.pop_back();
    points_[index(vertex)] = point;
    return vertex;
  }
  points_.push_back(point);
  some_edge_.push_back(none);
  return static_cast<int>(points_.size()) - 1;
}

int HalfEdges::new_triangle() {
  if (!free_triangles_.empty()) {
    const int triangle = free_triangles_.back();
    free_triangles_.pop_back();
    return triangle;
  }
  const int triangle = static_cast<int>(labels_.size());
  edges_.resize(edges_.size() + 4);
  labels_.push_back(dead);
  is_touched_.push_back(0);
  return triangle;
}

void HalfEdges::clear_touched() {
  for (const int triangle : touched_) is_touched_[index(triangle)] = 0;
  touched_.clear();
}

void HalfEdges::make(int triangle, int a, int b, int c, int label) {
  const int corners[] = {a, b, c};
  for (int i = 0; i < 3; ++i) {
    const int edge = half(triangle, i);
    edges_[index(edge)] = {corners[i], none, none, 0};
    some_edge_[index(corners[i])] = edge;
  }
  labels_[index(triangle)] = label;
  touch(triangle);
}

/// Gives a half-edge what another one had on its other side.
void HalfEdges::attach(int edge, const HalfEdge& side) {
  HalfEdge& own = edges_[index(edge)];
  own.twin = side.twin;
  own.flags = side.flags;
  own.tag = side.tag;
  if (side.twin != none) edges_[index(side.twin)].twin = edge;
}

void HalfEdges::join(int edge, int other) {
  edges_[index(edge)].twin = other;
  edges_[index(other)].twin = edge;
}

/// Of both half-edges of a side.
void HalfEdges::set_fixed(int edge, bool fixed, int tag) {
  for (const int half : {edge, twin(edge)}) {
    if (half == none) continue;
    edges_[index(half)].flags = fixed ? is_fixed : 0;
    edges_[index(half)].tag = tag;
  }
}

void HalfEdges::set_label(int triangle, int label) {
  labels_[index(triangle)] = label;
  touch(triangle);
}

void HalfEdges::settle_sides(int triangle) {
  for (const int edge : sides(triangle)) settle_side(edge);
}

void HalfEdges::settle_side(int edge) {
  const int other = twin(edge);
  if (other == none) return;
  const bool separates = label(triangle_of(edge)) != label(triangle_of(other));
  if (separates != fixed(edge)) set_fixed(edge, separates, none);
}

double HalfEdges::doubled_area(int triangle) const {
  const int edge = half(triangle, 0);
  return orientation(start(edge), end(edge), point(apex(edge)));
}

std::vector<int> HalfEdges::star(int vertex) const {
  std::vector<int> triangles;
  triangles.reserve(8);  // six on average
  any_around(vertex, [&](int edge) {
    triangles.push_back(triangle_of(edge));
    return false;
  });
  return triangles;
}

int HalfEdges::find_edge(int from, int to) const {
  int found = none;
  any_around(from, [&](int edge) {
    if (target(edge) == to) found = edge;
    return found != none;
  });
  return found;
}

void HalfEdges::flip(int edge) {
  const int other = twin(edge), first = triangle_of(edge), second = triangle_of(other);
  HalfEdge* const edges = edges_.data();
  const HalfEdge bc = edges[next(edge)], ca = edges[previous(edge)];
  const HalfEdge ad = edges[next(other)], db = edges[previous(other)];
  const int upper = half(first, 0), lower = half(second, 0);
  edges[upper] = ad;
  edges[upper + 1] = {db.origin, lower + 2, none, 0};
  edges[upper + 2] = ca;
  edges[lower] = db;
  edges[lower + 1] = bc;
  edges[lower + 2] = {ca.origin, upper + 1, none, 0};
  if (ad.twin != none) edges[ad.twin].twin = upper;
  if (ca.twin != none) edges[ca.twin].twin = upper + 2;
  if (db.twin != none) edges[db.twin].twin = lower;
  if (bc.twin != none) edges[bc.twin].twin = lower + 1;
  int* const some_edge = some_edge_.data();
  some_edge[ad.origin] = upper;
  some_edge[db.origin] = lower;
  some_edge[bc.origin] = lower + 1;
  some_edge[ca.origin] = lower + 2;
  touch(first);
  touch(second);
}

int HalfEdges::split_triangle(int triangle, const Vec2& position) {
  const int edge = half(triangle, 0), a = origin(edge), b = target(edge), c = apex(edge);
  const HalfEdge ab = edges_[index(edge)], bc = edges_[index(edge + 1)], ca = edges_[index(edge + 2)];
  const int vertex = new_vertex(position), second = new_triangle(), third = new_triangle();
  const int part = label(triangle);
  make(triangle, a, b, vertex, part);
  make(second, b, c, vertex, part);
  make(third, c, a, vertex, part);
  attach(half(triangle, 0), ab);
  attach(half(second, 0), bc);
  attach(half(third, 0), ca);
  join(half(triangle, 1), half(second, 2));
  join(half(second, 1), half(third, 2));
  join(half(third, 1), half(triangle, 2));
  return vertex;
}

int HalfEdges::split_edge(int edge, const Vec2& position) {
  const int other = twin(edge), first = triangle_of(edge), second = triangle_of(other);
  const int a = origin(edge), b = target(edge), c = apex(edge), d = apex(other);
  const HalfEdge ab = edges_[index(edge)], bc = edges_[index(next(edge))], ca = edges_[index(previous(edge))];
  const HalfEdge ad = edges_[index(next(other))], db = edges_[index(previous(other))];
  const int vertex = new_vertex(position), third = new_triangle(), fourth = new_triangle();
  const int upper = label(first), lower = label(second);
  make(first, vertex, c, a, upper);
  make(third, vertex, b, c, upper);
  make(second, vertex, a, d, lower);
  make(fourth, vertex, d, b, lower);
  attach(half(first, 1), ca);
  attach(half(third, 1), bc);
  attach(half(second, 1), ad);
  attach(half(fourth, 1), db);
  join(half(first, 0), half(third, 2));
  join(half(second, 2), half(fourth, 0));
  join(half(first, 2), half(second, 0));
  join(half(third, 0), half(fourth, 2));
  if ((ab.flags & is_fixed) != 0) {
    fix(half(first, 2), ab.tag);
    fix(half(third, 0), ab.tag);
  }
  return vertex;
}

int HalfEdges::merge_around(int vertex) {
  std::array<int, 3> around{}, corners{};
  std::array<HalfEdge, 3> outer{};
  std::size_t count = 0;
  any_around(vertex, [&](int edge) {
    around[count] = triangle_of(edge);
    outer[count] = edges_[index(next(edge))];
    corners[count] = outer[count].origin;
    return ++count == 3;
  });
  if (!(orientation(point(corners[0]), point(corners[1]), point(corners[2])) > 0)) return none;
  make(around[0], corners[0], corners[1], corners[2], label(around[0]));
  for (std::size_t i = 0; i < 3; ++i) attach(half(around[0], static_cast<int>(i)), outer[i]);
  for (const int gone : {around[1], around[2]}) {
    labels_[index(gone)] = dead;
    touch(gone);
    free_triangles_.push_back(gone);
  }
  free_vertices_.push_back(vertex);
  return around[0];
}

void HalfEdges::leave_all() {
  ++visit_;
  visited_.resize(labels_.size(), 0);
}

void HalfEdges::fill(const std::vector<int>& loop, std::vector<int>& triangles) {
  leave_all();
  for (const int edge : loop) {
    edges_[index(edge)].flags |= on_loop;
    if (visit(triangle_of(edge))) triangles.push_back(triangle_of(edge));
  }
  for (std::size_t i = 0; i < triangles.size(); ++i)
    for (const int edge : sides(triangles[i]))
      if (const HalfEdge& side = edges_[index(edge)]; (side.flags & on_loop) == 0 && side.twin != none)
        if (visit(triangle_of(side.twin))) triangles.push_back(triangle_of(side.twin));
  for (const int edge : loop) edges_[index(edge)].flags &= ~on_loop;
}

bool HalfEdges::valid() const {
  for (int triangle = 0; triangle < triangle_slots(); ++triangle) {
    if (!alive(triangle)) continue;
    if (!(doubled_area(triangle) > 0)) return false;
    for (const int edge : sides(triangle)) {
      const int other = twin(edge);
      if (other == none) continue;
      if (twin(other) != edge || origin(other) != target(edge) || !alive(triangle_of(other))) return false;
      if (fixed(edge) != fixed(other) || tag(edge) != tag(other)) return false;
      if (label(triangle) != label(triangle_of(other)) && !fixed(edge)) return false;
    }
  }
  return true;
}

}  // namespace topple::fracture
