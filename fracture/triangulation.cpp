#include "triangulation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "predicates.h"

namespace topple::fracture {

Triangulation::Triangulation(const Vec2& lower, const Vec2& upper, double tolerance)
    : HalfEdges(lower, upper), tolerance_(tolerance) {
  if (!((upper - lower).minCoeff() > 4 * tolerance && tolerance > 0))
    throw std::invalid_argument("triangulation: the box must be larger than the tolerance");
}

int Triangulation::locate(const Vec2& point) const {
  int triangle = hint_;
  if (triangle >= triangle_slots() || !alive(triangle))
    for (triangle = 0; !alive(triangle);) ++triangle;
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
  fill(edges, triangles);
  return true;
}

// Flips --------------------------------------------------------------------------------------------------------------

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

int Triangulation::split_fixed(int edge, const Vec2& position) {
  const double from_start = (position - start(edge)).norm(), from_end = (position - end(edge)).norm();
  const int nearest = from_start <= from_end ? origin(edge) : target(edge);
  if (std::min(from_start, from_end) <= tolerance_) return nearest;
  const double off = orientation(start(edge), end(edge), position);
  if (off == 0) {
    const int vertex = split_edge(edge, position);
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
  const int vertex = split_triangle(triangle, position);
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
      vertex = split_edge(edge, position);
  if (vertex == none) vertex = split_triangle(home, position);
  legalise_around(vertex);
  return vertex;
}

}  // namespace topple::fracture
