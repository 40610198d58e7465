// Segments of the triangulation: walking from one vertex to another, stopping at what lies in the way.
#include "predicates.h"
#include "triangulation.h"

namespace topple::fracture {

namespace {

/// More steps than any segment needs; a bound for the case that rounding plays a trick nobody has thought of.
constexpr std::size_t kMostSteps = 10000;

}  // namespace

/// Whether the segment has to go through a vertex: it passes within the tolerance, and either part is shorter.
bool Triangulation::passes(int vertex, int from, int to) const {
  if (vertex == from || vertex == to) return false;
  const Vec2 &p = point(vertex), &a = point(from), &b = point(to);
  if (!may_lie_within(p, a, b, tolerance_)) return false;
  const double whole = (b - a).norm();
  return distance_to_segment(p, a, b) <= tolerance_ && (p - a).norm() < whole && (p - b).norm() < whole;
}

/// The edge opposite `from` that the line to `to` leaves through; or `none`, and the vertex that lies on the line.
int Triangulation::first_crossed(int from, int to, int& on_the_way) const {
  on_the_way = to;
  const Vec2 &a = point(from), &b = point(to);
  int crossed = none, known = none;
  double known_side = 0;  // of the vertex `known`, which two triangles have in common
  any_around(from, [&](int edge) {
    const int right = target(edge), left = apex(edge);
    const double right_side = right == known ? known_side : orientation(a, b, point(right));
    const double left_side = orientation(a, b, point(left));
    known = left;
    known_side = left_side;
    if (right_side == 0 && (point(right) - a).dot(b - a) > 0) {
      on_the_way = right;
      return true;
    }
    if (right_side < 0 && left_side > 0) crossed = next(edge);
    return crossed != none;
  });
  return crossed;
}

int Triangulation::split_crossing(int edge, int from, int to) {
  const Vec2 &a = point(from), &b = point(to), &c = start(edge), &d = end(edge);
  const double before = orientation(a, b, c), beyond = orientation(a, b, d);
  return split_fixed(edge, c + before / (before - beyond) * (d - c));
}

/// The first vertex in the way of a segment, made where it crosses a fixed edge; `to` when the way is free, with the
/// edges that it crosses in `crossed_`, each from its right to its left.
int Triangulation::obstacle(int from, int to) {
  crossed_.clear();
  int vertex = to;
  int edge = first_crossed(from, to, vertex);
  if (edge == none) return vertex;
  if (passes(origin(edge), from, to)) return origin(edge);
  if (passes(target(edge), from, to)) return target(edge);
  for (;;) {
    if (fixed(edge)) return split_crossing(edge, from, to);
    const int other = twin(edge);
    if (other == none) return to;  // only from a corner of the box
    crossed_.emplace_back(origin(edge), target(edge));
    const int far = apex(other);
    if (far == to) return to;
    const double side = orientation(point(from), point(to), point(far));
    if (side == 0) return far;
    if (passes(far, from, to)) return far;
    edge = side > 0 ? next(other) : previous(other);
  }
}

/// Makes the edge between two vertices with nothing fixed and no vertex between them in place of those in `crossed_`:
/// S. Sloan, "A fast algorithm for generating constrained Delaunay triangulations" (1993).
void Triangulation::connect(int from, int to) {
  const Vec2 a = point(from), b = point(to);
  made_.clear();
  for (std::size_t steps = 0; steps < crossed_.size(); ++steps) {
    if (steps > kMostSteps) {
      ++unfinished_;
      return;
    }
    const auto [right, left] = crossed_[steps];
    const int half = find_edge(right, left);
    if (!may_flip(half)) {
      crossed_.emplace_back(right, left);  // once others are gone
      continue;
    }
    const int near = apex(half), far = apex(twin(half));
    flip(half);
    const double near_side = orientation(a, b, point(near)), far_side = orientation(a, b, point(far));
    const bool ends = near == from || near == to || far == from || far == to;
    if (!ends && (near_side > 0) != (far_side > 0))
      crossed_.emplace_back(near_side < 0 ? near : far, near_side < 0 ? far : near);
    else
      made_.emplace_back(near, far);
  }
  const int direct = find_edge(from, to);
  if (direct == none) {
    ++unfinished_;
    return;
  }
  if (!fixed(direct)) fix(direct, none);
  open_.clear();
  for (const auto& [one, other] : made_)
    if (const int edge = find_edge(one, other); edge != none) open_.push_back(edge);
  legalise_open();
}

/// Fixes the first part of a segment and says where it ends.
int Triangulation::advance(int from, int to) {
  for (std::size_t steps = 0; steps < kMostSteps; ++steps) {
    if (const int there = find_edge(from, to); there != none) {
      if (!fixed(there)) fix(there, none);
      return to;
    }
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
  for (std::size_t steps = 0; from != to; ++steps) {
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
  int degree = 0;
  if (any_around(vertex, [&](int edge) { return ++degree, fixed(edge); })) return false;
  for (; degree > 3; --degree) {
    int flippable = none;
    any_around(vertex, [&](int edge) {
      if (may_flip(edge)) flippable = edge;
      return flippable != none;
    });
    if (flippable == none) return false;
    flip(flippable);
  }
  const int merged = merge_around(vertex);
  if (merged == none) return false;
  open_.clear();
  for (const int edge : sides(merged)) open_.push_back(edge);
  legalise_open();
  return true;
}

}  // namespace topple::fracture
