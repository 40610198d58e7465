#include "convex_pieces.h"

#include <algorithm>

#include "predicates.h"

namespace topple::fracture {

/// The other half-edge when it belongs to the region and nothing separates the two.
int ConvexPieces::twin_of(int local) const {
  const int edge = global(local);
  const int twin = triangulation_.twin(edge);
  if (twin == Triangulation::none || triangulation_.fixed(edge)) return Triangulation::none;
  const int place = local_of_[index(Triangulation::triangle_of(twin))];
  if (index(place) >= triangles_.size() || triangles_[index(place)] != Triangulation::triangle_of(twin))
    return Triangulation::none;
  return Triangulation::half(place, Triangulation::side_of(twin));
}

void ConvexPieces::start(std::span<const int> triangles) {
  triangles_.assign(triangles.begin(), triangles.end());
  std::sort(triangles_.begin(), triangles_.end());
  const auto count = static_cast<int>(triangles_.size());
  local_of_.resize(index(triangulation_.triangle_slots()), 0);
  for (int i = 0; i < count; ++i) local_of_[index(triangles_[index(i)])] = i;
  const std::size_t edges = index(Triangulation::half(count, 0));
  twin_.resize(edges);
  next_.resize(edges);
  previous_.resize(edges);
  group_.resize(triangles_.size());
  for (int i = 0; i < count; ++i) {
    group_[index(i)] = i;
    for (const int edge : Triangulation::sides(i)) {
      twin_[index(edge)] = twin_of(edge);
      next_[index(edge)] = Triangulation::next(edge);
      previous_[index(edge)] = Triangulation::previous(edge);
    }
  }
  inner_.assign(edges, 0);
}

int ConvexPieces::find(int group) {
  while (group_[index(group)] != group) group = group_[index(group)] = group_[index(group_[index(group)])];
  return group;
}

bool ConvexPieces::convex(int before, int at, int after) const {
  const Vec2 &a = point(before), &b = point(at), &c = point(after);
  const double turn = orientation(a, b, c);
  return turn > 0 || (turn >= -triangulation_.tolerance() * (c - a).norm() && (b - a).dot(c - b) > 0);
}

void ConvexPieces::try_merge(int edge, int twin) {
  const int here = find(Triangulation::triangle_of(edge)), there = find(Triangulation::triangle_of(twin));
  if (here == there) return;
  const int before = previous_[index(edge)], after = next_[index(edge)];
  const int twin_before = previous_[index(twin)], twin_after = next_[index(twin)];
  // At both ends of the side: the corner before, the end itself, the corner after.
  if (!convex(before, edge, next_[index(twin_after)]) || !convex(twin_before, twin, next_[index(after)])) return;
  next_[index(before)] = twin_after;
  previous_[index(twin_after)] = before;
  next_[index(twin_before)] = after;
  previous_[index(after)] = twin_before;
  inner_[index(edge)] = inner_[index(twin)] = 1;
  group_[index(std::max(here, there))] = std::min(here, there);
}

/// The place in its piece's outline of the corner that a half-edge leaves: around the corner until a side is there.
int ConvexPieces::number_at(int edge) const {
  while (inner_[index(edge)]) edge = Triangulation::next(twin_[index(edge)]);
  return number_[index(edge)];
}

void ConvexPieces::append(std::span<const int> triangles, bool hit, std::vector<Chunk>& chunks) {
  start(triangles);
  const auto count = static_cast<int>(triangles_.size());
  for (int i = 0; i < count; ++i)
    for (const int edge : Triangulation::sides(i))
      if (twin_[index(edge)] > edge) try_merge(edge, twin_[index(edge)]);

  // Chunks in the order of their first triangles, with all the memory that they need.
  const std::size_t first_chunk = chunks.size();
  chunk_of_.resize(triangles_.size());
  corners_.clear();
  faces_.clear();
  for (int i = 0; i < count; ++i) {
    const int group = find(i);
    if (group == i) {
      chunk_of_[index(i)] = static_cast<int>(corners_.size());
      corners_.push_back(0);
      faces_.push_back(0);
    }
    const int chunk = chunk_of_[index(i)] = chunk_of_[index(group)];
    ++faces_[index(chunk)];
    for (const int edge : Triangulation::sides(i)) corners_[index(chunk)] += inner_[index(edge)] ? 0 : 1;
  }
  for (std::size_t i = 0; i < corners_.size(); ++i) {
    Chunk& chunk = chunks.emplace_back();
    chunk.hit = hit;
    chunk.outline.reserve(corners_[i]);
    chunk.face.reserve(faces_[i]);
  }
  number_.assign(next_.size(), Triangulation::none);
  for (int i = 0; i < count; ++i)
    for (const int first : Triangulation::sides(i)) {
      if (inner_[index(first)]) continue;
      Polygon& outline = chunks[first_chunk + index(chunk_of_[index(i)])].outline;
      for (int edge = first; number_[index(edge)] == Triangulation::none; edge = next_[index(edge)]) {
        number_[index(edge)] = static_cast<int>(outline.size());
        outline.push_back(point(edge));
      }
    }
  for (int i = 0; i < count; ++i) {
    const auto [a, b, c] = Triangulation::sides(i);
    chunks[first_chunk + index(chunk_of_[index(i)])].face.push_back({number_at(a), number_at(b), number_at(c)});
  }
}

}  // namespace topple::fracture
