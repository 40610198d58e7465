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
  join(3 * first + 2, 3 * second);
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
  origins_.resize(origins_.size() + 3, none);
  twins_.resize(origins_.size(), none);
  tags_.resize(origins_.size(), none);
  fixed_.resize(origins_.size(), 0);
  labels_.push_back(dead);
  is_touched_.push_back(0);
  return triangle;
}

void Triangulation::touch(int triangle) {
  if (is_touched_[index(triangle)]) return;
  is_touched_[index(triangle)] = 1;
  touched_.push_back(triangle);
}

void Triangulation::clear_touched() {
  for (const int triangle : touched_) is_touched_[index(triangle)] = 0;
  touched_.clear();
}

void Triangulation::make(int triangle, int a, int b, int c, int label) {
  const int corners[] = {a, b, c};
  for (int i = 0; i < 3; ++i) {
    const int edge = 3 * triangle + i;
    origins_[index(edge)] = corners[i];
    some_edge_[index(corners[i])] = edge;
    attach(edge, {});
  }
  labels_[index(triangle)] = label;
  touch(triangle);
}

void Triangulation::attach(int edge, const Side& side) {
  twins_[index(edge)] = side.twin;
  fixed_[index(edge)] = side.fixed;
  tags_[index(edge)] = side.tag;
  if (side.twin != none) twins_[index(side.twin)] = edge;
}

void Triangulation::join(int edge, int other) {
  twins_[index(edge)] = other;
  twins_[index(other)] = edge;
}

void Triangulation::fix(int edge, int tag) {
  for (const int half : {edge, twin(edge)}) {
    if (half == none) continue;
    fixed_[index(half)] = 1;
    tags_[index(half)] = tag;
  }
}

void Triangulation::set_tag(int edge, int tag) { fix(edge, tag); }

void Triangulation::set_label(int triangle, int label) {
  labels_[index(triangle)] = label;
  touch(triangle);
}

void Triangulation::settle_sides(int triangle) {
  for (int edge = 3 * triangle; edge < 3 * triangle + 3; ++edge) {
    const int other = twin(edge);
    if (other == none) continue;
    const bool separates = label(triangle) != label(other / 3);
    if (separates == fixed(edge)) continue;
    for (const int half : {edge, other}) {
      fixed_[index(half)] = separates;
      tags_[index(half)] = none;
    }
  }
}

double Triangulation::doubled_area(int triangle) const {
  const int edge = 3 * triangle;
  return orientation(start(edge), end(edge), point(apex(edge)));
}

std::vector<int> Triangulation::star(int vertex) const {
  std::vector<int> triangles;
  triangles.reserve(8);  // six on average
  const int first = some_edge_[index(vertex)];
  int edge = first;
  do {
    triangles.push_back(edge / 3);
    edge = twin(previous(edge));
  } while (edge != none && edge != first);
  if (edge == none)  // a corner of the box: the other way round as well
    for (edge = twin(first); edge != none; edge = twin(next(edge))) triangles.push_back(edge / 3);
  return triangles;
}

int Triangulation::find_edge(int from, int to) const {
  for (const int triangle : star(from))
    for (int edge = 3 * triangle; edge < 3 * triangle + 3; ++edge) {
      if (origin(edge) == from && target(edge) == to) return edge;
      if (origin(edge) == to && target(edge) == from && twin(edge) != none) return twin(edge);
    }
  return none;
}

int Triangulation::locate(const Vec2& point) const {
  int triangle = hint_;
  if (triangle >= triangle_slots() || !alive(triangle))
    triangle = static_cast<int>(std::find_if(labels_.begin(), labels_.end(), [](int l) { return l != dead; }) -
                                labels_.begin());
  // Which side is asked first changes from step to step: a walk that always turned the same way could go in circles.
  unsigned turn = 0;
  for (int steps = 0; steps < 4 * triangle_slots() + 16; ++steps) {
    int out = none;
    for (unsigned i = 0; i < 3 && out == none; ++i) {
      const int edge = 3 * triangle + static_cast<int>((i + turn) % 3);
      if (orientation(start(edge), end(edge), point) < 0) out = edge;
    }
    if (out == none || twin(out) == none) {
      hint_ = triangle;
      return triangle;
    }
    triangle = twin(out) / 3;
    turn = turn * 1664525u + 1013904223u;
    turn ^= turn >> 16;
  }
  for (triangle = 0; triangle < triangle_slots(); ++triangle) {
    if (!alive(triangle)) continue;
    bool inside = true;
    for (int edge = 3 * triangle; edge < 3 * triangle + 3; ++edge)
      inside = inside && orientation(start(edge), end(edge), point) >= 0;
    if (inside) return hint_ = triangle;
  }
  throw std::logic_error("triangulation: a point lies in no triangle");
}

// Flips --------------------------------------------------------------------------------------------------------------

bool Triangulation::may_flip(int edge) const {
  const int other = twin(edge);
  if (other == none) return false;
  const Vec2 &a = start(edge), &b = end(edge), &c = point(apex(edge)), &d = point(apex(other));
  return orientation(a, d, c) > 0 && orientation(d, b, c) > 0;
}

void Triangulation::flip(int edge) {
  const int other = twin(edge), first = edge / 3, second = other / 3;
  const int a = origin(edge), b = target(edge), c = apex(edge), d = apex(other);
  const Side bc = side(next(edge)), ca = side(previous(edge)), ad = side(next(other)), db = side(previous(other));
  make(first, a, d, c, label(first));
  make(second, d, b, c, label(second));
  attach(3 * first, ad);
  attach(3 * first + 2, ca);
  attach(3 * second, db);
  attach(3 * second + 1, bc);
  join(3 * first + 1, 3 * second + 2);
}

void Triangulation::legalise(std::vector<int>& edges) {
  while (!edges.empty()) {
    const int edge = edges.back();
    edges.pop_back();
    const int other = twin(edge);
    if (other == none || fixed(edge)) continue;
    if (!certainly_in_circle(start(edge), end(edge), point(apex(edge)), point(apex(other))) || !may_flip(edge))
      continue;
    const int first = edge / 3, second = other / 3;
    flip(edge);
    edges.insert(edges.end(), {3 * first, 3 * first + 2, 3 * second, 3 * second + 1});
  }
}

// Points -------------------------------------------------------------------------------------------------------------

int Triangulation::insert_inside(int triangle, const Vec2& position) {
  const int edge = 3 * triangle, a = origin(edge), b = target(edge), c = apex(edge);
  const Side ab = side(edge), bc = side(edge + 1), ca = side(edge + 2);
  const int vertex = new_vertex(position), second = new_triangle(), third = new_triangle();
  const int part = label(triangle);
  make(triangle, a, b, vertex, part);
  make(second, b, c, vertex, part);
  make(third, c, a, vertex, part);
  attach(3 * triangle, ab);
  attach(3 * second, bc);
  attach(3 * third, ca);
  join(3 * triangle + 1, 3 * second + 2);
  join(3 * second + 1, 3 * third + 2);
  join(3 * third + 1, 3 * triangle + 2);
  return vertex;
}

int Triangulation::split_at(int edge, const Vec2& position) {
  const int other = twin(edge), first = edge / 3, second = other / 3;
  const int a = origin(edge), b = target(edge), c = apex(edge), d = apex(other);
  const Side ab = side(edge), bc = side(next(edge)), ca = side(previous(edge)), ad = side(next(other)),
             db = side(previous(other));
  const int vertex = new_vertex(position), third = new_triangle(), fourth = new_triangle();
  const int upper = label(first), lower = label(second);
  make(first, vertex, c, a, upper);
  make(third, vertex, b, c, upper);
  make(second, vertex, a, d, lower);
  make(fourth, vertex, d, b, lower);
  attach(3 * first + 1, ca);
  attach(3 * third + 1, bc);
  attach(3 * second + 1, ad);
  attach(3 * fourth + 1, db);
  join(3 * first, 3 * third + 2);
  join(3 * second + 2, 3 * fourth);
  join(3 * first + 2, 3 * second);
  join(3 * third, 3 * fourth + 2);
  if (ab.fixed) {
    fix(3 * first + 2, ab.tag);
    fix(3 * third, ab.tag);
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
    std::vector<int> around;
    for (const int triangle : star(vertex))
      around.insert(around.end(), {3 * triangle, 3 * triangle + 1, 3 * triangle + 2});
    legalise(around);
    return vertex;
  }
  // Rounding has put the point beside the edge. The edge goes through it from now on: the sliver between the old and
  // the new edge changes sides.
  if (off < 0) edge = twin(edge);
  const int triangle = edge / 3, beyond = label(twin(edge) / 3), edge_tag = tag(edge);
  if (!(orientation(end(edge), point(apex(edge)), position) > 0 &&
        orientation(point(apex(edge)), start(edge), position) > 0))
    return nearest;
  const int a = origin(edge), b = target(edge);
  const int vertex = insert_inside(triangle, position);
  const int old = find_edge(a, b);
  set_label(old / 3, beyond);
  for (const int half : {old, twin(old)}) {
    fixed_[index(half)] = 0;
    tags_[index(half)] = none;
  }
  fix(next(old), edge_tag);
  fix(previous(old), edge_tag);
  std::vector<int> around;
  for (const int beside : star(vertex)) around.insert(around.end(), {3 * beside, 3 * beside + 1, 3 * beside + 2});
  legalise(around);
  return vertex;
}

int Triangulation::add_point(const Vec2& position) {
  const int home = locate(position);
  int nearest = none, beside = none;
  double vertex_distance = tolerance_, edge_distance = tolerance_;
  // All triangles that come within the tolerance, to see every vertex and fixed edge there.
  collect_near(home, [&](int edge) {
    const double to_vertex = (start(edge) - position).norm();
    if (to_vertex <= vertex_distance) {
      vertex_distance = to_vertex;
      nearest = origin(edge);
    }
    const double to_edge = distance_to_segment(position, start(edge), end(edge));
    if (fixed(edge) && to_edge <= edge_distance) {
      edge_distance = to_edge;
      beside = edge;
    }
    return to_edge <= tolerance_;
  });
  if (nearest != none) return nearest;
  if (beside != none) {
    const Vec2 along = end(beside) - start(beside);
    const double share = (position - start(beside)).dot(along) / along.squaredNorm();
    return split_fixed(beside, start(beside) + share * along);
  }
  int vertex = none;
  for (int edge = 3 * home; edge < 3 * home + 3 && vertex == none; ++edge)
    if (twin(edge) != none && orientation(start(edge), end(edge), position) == 0) vertex = split_at(edge, position);
  if (vertex == none) vertex = insert_inside(home, position);
  std::vector<int> around;
  for (const int triangle : star(vertex))
    around.insert(around.end(), {3 * triangle, 3 * triangle + 1, 3 * triangle + 2});
  legalise(around);
  return vertex;
}

}  // namespace topple::fracture
