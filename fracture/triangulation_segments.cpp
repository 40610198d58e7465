// Segments of the triangulation: walking from one vertex to another, stopping at what lies in the way.
#include <algorithm>
#include <deque>

#include "predicates.h"
#include "triangulation.h"

namespace topple::fracture {

namespace {

/// More steps than any segment needs; a bound for the case that rounding plays a trick nobody has thought of.
constexpr int kMostSteps = 10000;

}  // namespace

/// Whether the segment has to go through a vertex: it passes within the tolerance, and either part is shorter.
bool Triangulation::passes(int vertex, int from, int to) const {
  if (vertex == from || vertex == to) return false;
  const Vec2 &p = point(vertex), &a = point(from), &b = point(to);
  const double whole = (b - a).norm();
  return distance_to_segment(p, a, b) <= tolerance_ && (p - a).norm() < whole && (p - b).norm() < whole;
}

/// The edge opposite `from` that the line to `to` leaves through; or `none`, and the vertex that lies on the line.
int Triangulation::first_crossed(int from, int to, int& on_the_way) const {
  const Vec2 &a = point(from), &b = point(to);
  for (const int triangle : star(from)) {
    int edge = 3 * triangle;
    while (origin(edge) != from) ++edge;
    const int right = target(edge), left = apex(edge);
    if (right == to || left == to) {
      on_the_way = to;
      return none;
    }
    const double right_side = orientation(a, b, point(right)), left_side = orientation(a, b, point(left));
    if (right_side == 0 && (point(right) - a).dot(b - a) > 0) {
      on_the_way = right;
      return none;
    }
    if (right_side < 0 && left_side > 0) return next(edge);
  }
  on_the_way = to;
  return none;
}

int Triangulation::split_crossing(int edge, int from, int to) {
  const Vec2 &a = point(from), &b = point(to), &c = start(edge), &d = end(edge);
  const double before = orientation(a, b, c), beyond = orientation(a, b, d);
  return split_fixed(edge, c + before / (before - beyond) * (d - c));
}

/// The first vertex in the way of a segment, made where it crosses a fixed edge; `to` when the way is free.
int Triangulation::obstacle(int from, int to) {
  int vertex = to;
  int edge = first_crossed(from, to, vertex);
  if (edge == none) return vertex;
  for (;;) {
    // The edge runs from the right of the segment to its left.
    for (const int corner : {origin(edge), target(edge)})
      if (passes(corner, from, to)) return corner;
    if (fixed(edge)) return split_crossing(edge, from, to);
    const int other = twin(edge);
    if (other == none) return to;  // only from a corner of the box
    const int far = apex(other);
    if (far == to) return to;
    const double side = orientation(point(from), point(to), point(far));
    if (side == 0) return far;
    edge = side > 0 ? next(other) : previous(other);
  }
}

/// Makes the edge between two vertices with nothing fixed and no vertex between them: S. Sloan, "A fast algorithm for
/// generating constrained Delaunay triangulations" (1993).
void Triangulation::connect(int from, int to) {
  int unused = to;
  int edge = first_crossed(from, to, unused);
  const Vec2 a = point(from), b = point(to);
  if (edge == none) {  // it is there already
    if (const int there = find_edge(from, to); there == none)
      ++unfinished_;
    else if (!fixed(there))
      fix(there, none);
    return;
  }
  std::deque<std::pair<int, int>> crossed;
  while (edge != none) {
    crossed.emplace_back(origin(edge), target(edge));
    const int other = twin(edge), far = apex(other);
    if (far == to) break;
    edge = orientation(a, b, point(far)) > 0 ? next(other) : previous(other);
  }
  std::vector<std::pair<int, int>> made;
  for (int steps = 0; !crossed.empty(); ++steps) {
    if (steps > kMostSteps) {
      ++unfinished_;
      return;
    }
    const auto [right, left] = crossed.front();
    crossed.pop_front();
    const int half = find_edge(right, left);
    if (!may_flip(half)) {
      crossed.emplace_back(right, left);
      continue;
    }
    const int near = apex(half), far = apex(twin(half));
    flip(half);
    const double near_side = orientation(a, b, point(near)), far_side = orientation(a, b, point(far));
    const bool ends = near == from || near == to || far == from || far == to;
    if (!ends && (near_side > 0) != (far_side > 0))
      crossed.emplace_back(near_side < 0 ? near : far, near_side < 0 ? far : near);
    else
      made.emplace_back(near, far);
  }
  const int direct = find_edge(from, to);
  if (direct == none) {
    ++unfinished_;
    return;
  }
  if (!fixed(direct)) fix(direct, none);
  std::vector<int> edges;
  for (const auto& [one, other] : made) edges.push_back(find_edge(one, other));
  std::erase(edges, static_cast<int>(none));
  legalise(edges);
}

/// Fixes the first part of a segment and says where it ends.
int Triangulation::advance(int from, int to) {
  for (int steps = 0; steps < kMostSteps; ++steps) {
    const int stop = obstacle(from, to);
    if (stop == from) break;
    if (stop == to) {
      connect(from, to);
      return to;
    }
    to = stop;
  }
  ++unfinished_;
  return to;
}

void Triangulation::add_segment(int from, int to, std::vector<int>& chain) {
  for (int steps = 0; from != to; ++steps) {
    if (steps > kMostSteps) {
      ++unfinished_;
      return;
    }
    from = advance(from, to);
    chain.push_back(from);
  }
}

bool Triangulation::remove_vertex(int vertex) {
  if (vertex < 4) return false;
  for (;;) {
    const std::vector<int> around = star(vertex);
    for (const int triangle : around)
      for (int edge = 3 * triangle; edge < 3 * triangle + 3; ++edge)
        if (origin(edge) == vertex && fixed(edge)) return false;
    if (around.size() == 3) break;
    bool flipped = false;
    for (const int triangle : around) {
      int edge = 3 * triangle;
      while (origin(edge) != vertex) ++edge;
      if (!may_flip(edge)) continue;
      flip(edge);
      flipped = true;
      break;
    }
    if (!flipped) return false;
  }
  const std::vector<int> around = star(vertex);
  std::array<int, 3> corners{}, outer{};
  std::array<Side, 3> sides{};
  for (std::size_t i = 0; i < 3; ++i) {
    int edge = 3 * around[i];
    while (origin(edge) != vertex) ++edge;
    outer[i] = next(edge);
    corners[i] = origin(outer[i]);
    sides[i] = side(outer[i]);
  }
  if (!(orientation(point(corners[0]), point(corners[1]), point(corners[2])) > 0)) return false;
  make(around[0], corners[0], corners[1], corners[2], label(around[0]));
  std::vector<int> edges;
  for (std::size_t i = 0; i < 3; ++i) {
    const int edge = 3 * around[0] + static_cast<int>(i);
    attach(edge, sides[i]);
    edges.push_back(edge);
  }
  for (const int gone : {around[1], around[2]}) {
    labels_[index(gone)] = dead;
    touch(gone);
    free_triangles_.push_back(gone);
  }
  free_vertices_.push_back(vertex);
  legalise(edges);
  return true;
}

bool Triangulation::valid() const {
  for (int triangle = 0; triangle < triangle_slots(); ++triangle) {
    if (!alive(triangle)) continue;
    if (!(doubled_area(triangle) > 0)) return false;
    for (int edge = 3 * triangle; edge < 3 * triangle + 3; ++edge) {
      const int other = twin(edge);
      if (other == none) continue;
      if (twin(other) != edge || origin(other) != target(edge) || !alive(other / 3)) return false;
      if (fixed(edge) != fixed(other) || tag(edge) != tag(other)) return false;
      if (label(triangle) != label(other / 3) && !fixed(edge)) return false;
    }
  }
  return true;
}

}  // namespace topple::fracture
