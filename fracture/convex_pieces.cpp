#include "convex_pieces.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "predicates.h"

namespace topple::fracture {

namespace {

class Merger {
 public:
  Merger(const Triangulation& triangulation, const std::vector<int>& triangles)
      : triangulation_(triangulation), triangles_(triangles) {
    std::sort(triangles_.begin(), triangles_.end());
    const std::size_t edges = 3 * triangles_.size();
    next_.resize(edges);
    previous_.resize(edges);
    for (std::size_t i = 0; i < triangles_.size(); ++i)
      for (std::size_t side = 0; side < 3; ++side) {
        next_[3 * i + side] = static_cast<int>(3 * i + (side + 1) % 3);
        previous_[3 * i + side] = static_cast<int>(3 * i + (side + 2) % 3);
      }
    group_.resize(triangles_.size());
    std::iota(group_.begin(), group_.end(), 0);
    inner_.assign(edges, false);
  }

  std::vector<Chunk> run() {
    for (int local = 0; local < static_cast<int>(next_.size()); ++local) {
      const int twin = twin_of(local);
      if (twin > local) try_merge(local, twin);
    }
    return chunks();
  }

 private:
  static std::size_t index(int i) { return static_cast<std::size_t>(i); }
  [[nodiscard]] int global(int local) const { return 3 * triangles_[index(local / 3)] + local % 3; }
  [[nodiscard]] int corner(int local) const { return triangulation_.origin(global(local)); }
  [[nodiscard]] const Vec2& point(int local) const { return triangulation_.point(corner(local)); }

  /// The other half-edge when it belongs to the region and nothing separates the two.
  [[nodiscard]] int twin_of(int local) const {
    const int twin = triangulation_.twin(global(local));
    if (twin == Triangulation::none || triangulation_.fixed(twin)) return -1;
    const auto found = std::lower_bound(triangles_.begin(), triangles_.end(), twin / 3);
    if (found == triangles_.end() || *found != twin / 3) return -1;
    return 3 * static_cast<int>(found - triangles_.begin()) + twin % 3;
  }

  int find(int group) {
    while (group_[index(group)] != group) group = group_[index(group)] = group_[index(group_[index(group)])];
    return group;
  }

  [[nodiscard]] bool convex(int before, int at, int after) const {
    const Vec2 &a = point(before), &b = point(at), &c = point(after);
    const double turn = orientation(a, b, c);
    return turn > 0 || (turn >= -triangulation_.tolerance() * (c - a).norm() && (b - a).dot(c - b) > 0);
  }

  void try_merge(int edge, int twin) {
    const int here = find(edge / 3), there = find(twin / 3);
    if (here == there) return;
    const int before = previous_[index(edge)], after = next_[index(edge)];
    const int twin_before = previous_[index(twin)], twin_after = next_[index(twin)];
    // At both ends of the side: the corner before, the end itself, the corner after.
    if (!convex(before, edge, next_[index(twin_after)]) || !convex(twin_before, twin, next_[index(after)])) return;
    next_[index(before)] = twin_after;
    previous_[index(twin_after)] = before;
    next_[index(twin_before)] = after;
    previous_[index(after)] = twin_before;
    inner_[index(edge)] = inner_[index(twin)] = true;
    group_[index(std::max(here, there))] = std::min(here, there);
  }

  std::vector<Chunk> chunks() {
    // A group is known by its first triangle.
    std::vector<int> place(triangles_.size(), -1);
    int count = 0;
    for (int i = 0; i < static_cast<int>(triangles_.size()); ++i)
      if (find(i) == i) place[index(i)] = count++;
    std::vector<Chunk> result(index(count));
    std::vector<std::vector<std::pair<int, int>>> numbers(index(count));  // of corners in the outline
    std::vector<bool> seen(next_.size(), false);
    for (int first = 0; first < static_cast<int>(next_.size()); ++first) {
      if (inner_[index(first)] || seen[index(first)]) continue;
      const std::size_t group = index(place[index(find(first / 3))]);
      Polygon& outline = result[group].outline;
      for (int edge = first; !seen[index(edge)]; edge = next_[index(edge)]) {
        seen[index(edge)] = true;
        numbers[group].emplace_back(corner(edge), static_cast<int>(outline.size()));
        outline.push_back(point(edge));
      }
    }
    for (auto& list : numbers) std::sort(list.begin(), list.end());
    for (int i = 0; i < static_cast<int>(triangles_.size()); ++i) {
      const std::size_t group = index(place[index(find(i))]);
      const auto number_of = [&](int vertex) {
        return std::lower_bound(numbers[group].begin(), numbers[group].end(), std::pair(vertex, 0))->second;
      };
      result[group].face.push_back(
          {number_of(corner(3 * i)), number_of(corner(3 * i + 1)), number_of(corner(3 * i + 2))});
    }
    return result;
  }

  const Triangulation& triangulation_;
  std::vector<int> triangles_, next_, previous_, group_;
  std::vector<bool> inner_;
};

}  // namespace

std::vector<Chunk> convex_pieces(const Triangulation& triangulation, const std::vector<int>& triangles) {
  return Merger(triangulation, triangles).run();
}

}  // namespace topple::fracture
