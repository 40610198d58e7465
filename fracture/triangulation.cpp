#include "triangulation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "predicates.h"

namespace topple::fracture {

Triangulation::Triangulation(const Vec2& lower, const Vec2& upper, double tolerance) : tolerance_(tolerance) {
  if (!((upper - lower).minCoeff() > 4 * tolerance && tolerance > 0))
    throw std::invalid_argument("triangulation: the box must be larger than the tolerance");
  for (const Vec2& corner : {lower, Vec2(upper.x(), lower.y()), upper, Vec2(lower.x(), upper.y())}) new_vertex(corner);
  const int first = new_triangle(), second = new_triangle();
  make(first, 0, 1, 2, 0);
  make(second, 0, 2, 3, 0);
  join(half(first, 2), half(second, 0));
}

int Triangulation::new_vertex(const Vec2& point) {
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

int Triangulation::new_triangle() {
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

void Triangulation::clear_touched() {
  for (const int triangle : touched_) is_touched_[index(triangle)] = 0;
  touched_.clear();
}

void Triangulation::make(int triangle, int a, int b, int c, int label) {
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
void Triangulation::attach(int edge, const HalfEdge& side) {
  HalfEdge& own = edges_[index(edge)];
  own.twin = side.twin;
  own.flags = side.flags;
  own.tag = side.tag;
  if (side.twin != none) edges_[index(side.twin)].twin = edge;
}

void Triangulation::join(int edge, int other) {
  edges_[index(edge)].twin = other;
  edges_[index(other)].twin = edge;
}

/// Of both half-edges of a side.
void Triangulation::set_fixed(int edge, bool fixed, int tag) {
  for (const int half : {edge, twin(edge)}) {
    if (half == none) continue;
    edges_[index(half)].flags = fixed ? is_fixed : 0;
    edges_[index(half)].tag = tag;
  }
}

void Triangulation::fix(int edge, int tag) { set_fixed(edge, true, tag); }

void Triangulation::set_tag(int edge, int tag) { fix(edge, tag); }

void Triangulation::set_label(int triangle, int label) {
  labels_[index(triangle)] = label;
  touch(triangle);
}

void Triangulation::settle_sides(int triangle) {
  for (const int edge : sides(triangle)) settle_side(edge);
}

void Triangulation::settle_side(int edge) {
  const int other = twin(edge);
  if (other == none) return;
  const bool separates = label(triangle_of(edge)) != label(triangle_of(other));
  if (separates != fixed(edge)) set_fixed(edge, separates, none);
}

double Triangulation::doubled_area(int triangle) const {
  const int edge = half(triangle, 0);
  return orientation(start(edge), end(edge), point(apex(edge)));
}

std::vector<int> Triangulation::star(int vertex) const {
  std::vector<int> triangles;
  triangles.reserve(8);  // six on average
  any_around(vertex, [&](int edge) {
    triangles.push_back(triangle_of(edge));
    return false;
  });
  return triangles;
}

int Triangulation::find_edge(int from, int to) const {
  int found = none;
  any_around(from, [&](int edge) {
    if (target(edge) == to) found = edge;
    return found != none;
  });
  return found;
}

int Triangulation::locate(const Vec2& point) const {
  int triangle = hint_;
  if (triangle >= triangle_slots() || !alive(triangle))
    triangle = static_cast<int>(std::find_if(labels_.begin(), labels_.end(), [](int l) { return l != dead; }) -
                                labels_.begin());
  // Which side is asked first changes from step to step: a walk that always turned the same way could go in circles.
  unsigned turn = 0;
  int entered = none;  // the side that the walk came in through, with the point on its inner side
  for (int steps = 0; steps < 4 * triangle_slots() + 16; ++steps) {
    int out = none, edge = half(triangle, static_cast<int>(turn % 3));
    for (int i = 0; i < 3 && out == none; ++i, edge = next(edge))
      if (edge != entered && orientation(start(edge), end(edge), point) < 0) out = edge;
    if (out == none || twin(out) == none) {
      hint_ = triangle;
      return triangle;
    }
    entered = twin(out);
    triangle = triangle_of(entered);
    turn = turn * 1664525u + 1013904223u;
    turn ^= turn >> 16;
  }
  for (triangle = 0; triangle < triangle_slots(); ++triangle) {
    if (!alive(triangle)) continue;
    bool inside = true;
    for (const int edge : sides(triangle)) inside = inside && orientation(start(edge), end(edge), point) >= 0;
    if (inside) return hint_ = triangle;
  }
  throw std::logic_error("triangulation: a point lies in no triangle");
}

bool Triangulation::enclose(const std::vector<int>& chain, std::vector<int>& triangles, std::vector<int>& edges) {
  triangles.clear();
  edges.clear();
  const Vec2& base = point(chain.front());
  double doubled = 0, farthest2 = 0;
  for (std::size_t i = 0; i < chain.size(); ++i) {
    const std::size_t next = i + 1 < chain.size() ? i + 1 : 0;
    const int edge = find_edge(chain[i], chain[next]);
    if (edge == none) return false;
    edges.push_back(edge);
    const Vec2 a = point(chain[i]) - base, b = point(chain[next]) - base;
    doubled += a.x() * b.y() - a.y() * b.x();
    farthest2 = std::max(farthest2, a.squaredNorm());
  }
  constexpr double least_area = 1e-9;  // of the square of its size: that the loop has, or rounding might have turned it
  if (!(doubled > least_area * farthest2)) return false;
  std::vector<int>& corners = near_;
  corners = chain;
  std::sort(corners.begin(), corners.end());
  if (std::adjacent_find(corners.begin(), corners.end()) != corners.end()) return false;
  ++visit_;
  visited_.resize(labels_.size(), 0);
  const auto take = [&](int triangle) {
    if (visited_[index(triangle)] == visit_) return;
    visited_[index(triangle)] = visit_;
    triangles.push_back(triangle);
  };
  for (const int edge : edges) {
    edges_[index(edge)].flags |= on_loop;
    take(triangle_of(edge));
  }
  for (std::size_t i = 0; i < triangles.size(); ++i)
    for (const int edge : sides(triangles[i]))
      if (const HalfEdge& side = edges_[index(edge)]; (side.flags & on_loop) == 0 && side.twin != none)
        take(triangle_of(side.twin));
  for (const int edge : edges) edges_[index(edge)].flags &= ~on_loop;
  return true;
}

// Flips --------------------------------------------------------------------------------------------------------------

void Triangulation::flip(int edge) {
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

/// Lawson's flips, from the half-edges in `open_` on.
void Triangulation::legalise_open() {
  while (!open_.empty()) {
    const int edge = open_.back();
    open_.pop_back();
    const int other = twin(edge);
    if (other == none || fixed(edge)) continue;
    if (!certainly_in_circle(start(edge), end(edge), point(apex(edge)), point(apex(other))) || !may_flip(edge))
      continue;
    const int first = triangle_of(edge), second = triangle_of(other);
    flip(edge);
    open_.insert(open_.end(), {half(first, 0), half(first, 2), half(second, 0), half(second, 1)});
  }
}

void Triangulation::legalise_around(int vertex) {
  open_.clear();
  any_around(vertex, [&](int edge) {
    const int first = half(triangle_of(edge), 0);
    open_.insert(open_.end(), {first, first + 1, first + 2});
    return false;
  });
  legalise_open();
}

// Points -------------------------------------------------------------------------------------------------------------

int Triangulation::insert_inside(int triangle, const Vec2& position) {
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

int Triangulation::split_at(int edge, const Vec2& position) {
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

int Triangulation::split_fixed(int edge, const Vec2& position) {
  const double from_start = (position - start(edge)).norm(), from_end = (position - end(edge)).norm();
  const int nearest = from_start <= from_end ? origin(edge) : target(edge);
  if (std::min(from_start, from_end) <= tolerance_) return nearest;
  const double off = orientation(start(edge), end(edge), position);
  if (off == 0) {
    const int vertex = split_at(edge, position);
    legalise_around(vertex);
    return vertex;
  }
  // Rounding has put the point beside the edge. The edge goes through it from now on: the sliver between the old and
  // the new edge changes sides.
  if (off < 0) edge = twin(edge);
  const int triangle = triangle_of(edge), beyond = label(triangle_of(twin(edge))), edge_tag = tag(edge);
  if (!(orientation(end(edge), point(apex(edge)), position) > 0 &&
        orientation(point(apex(edge)), start(edge), position) > 0))
    return nearest;
  const int a = origin(edge), b = target(edge);
  const int vertex = insert_inside(triangle, position);
  const int old = find_edge(a, b);
  set_label(triangle_of(old), beyond);
  set_fixed(old, false, none);
  fix(next(old), edge_tag);
  fix(previous(old), edge_tag);
  legalise_around(vertex);
  return vertex;
}

int Triangulation::add_point(const Vec2& position) {
  const int home = locate(position);
  // A corner that is all but the point itself is the nearest vertex.
  for (const int edge : sides(home))
    if ((start(edge) - position).squaredNorm() <= 1e-6 * tolerance_ * tolerance_) return origin(edge);
  int nearest = none, on_edge = none;
  double vertex_distance = tolerance_, edge_distance = tolerance_;
  // All triangles that come within the tolerance, to see every vertex and fixed edge there.
  collect_near(home, [&](int edge) {
    if (!may_lie_within(position, start(edge), end(edge), tolerance_)) return false;
    const double to_vertex = (start(edge) - position).norm();
    if (to_vertex <= vertex_distance) {
      vertex_distance = to_vertex;
      nearest = origin(edge);
    }
    const double to_edge = distance_to_segment(position, start(edge), end(edge));
    if (fixed(edge) && to_edge <= edge_distance) {
      edge_distance = to_edge;
      on_edge = edge;
    }
    return to_edge <= tolerance_;
  });
  if (nearest != none) return nearest;
  if (on_edge != none) {
    const Vec2 along = end(on_edge) - start(on_edge);
    const double share = (position - start(on_edge)).dot(along) / along.squaredNorm();
    return split_fixed(on_edge, start(on_edge) + share * along);
  }
  int vertex = none;
  for (const int edge : sides(home))
    if (vertex == none && twin(edge) != none && orientation(start(edge), end(edge), position) == 0)
      vertex = split_at(edge, position);
  if (vertex == none) vertex = insert_inside(home, position);
  legalise_around(vertex);
  return vertex;
}

}  // namespace topple::fracture
