#include "loose_parts.h"

#include <utility>

namespace topple::fracture {

bool LooseParts::is_held(int triangle) const {
  for (const int edge : HalfEdges::sides(triangle)) {
    const int tag = triangles_.tag(edge);
    if (tag >= 0 && held_[static_cast<std::size_t>(tag)]) return true;
  }
  return false;
}

int LooseParts::neighbour(int edge) const {
  const int twin = triangles_.twin(edge);
  if (twin == HalfEdges::none || triangles_.label(HalfEdges::triangle_of(twin)) != intact_) return HalfEdges::none;
  return HalfEdges::triangle_of(twin);
}

std::vector<std::vector<int>> LooseParts::beside(const std::vector<int>& removed) const {
  std::vector<int> neighbours;
  for (const int triangle : removed)
    for (const int edge : HalfEdges::sides(triangle))
      if (const int other = neighbour(edge); other != HalfEdges::none) neighbours.push_back(other);
  return around(neighbours);
}

std::vector<std::vector<int>> LooseParts::around(const std::vector<int>& starts) const {
  std::vector<int> part_of(static_cast<std::size_t>(triangles_.triangle_slots()), -1);
  std::vector<char> held;
  std::vector<std::vector<int>> parts;
  const auto search = [&](int start) {
    const int part = static_cast<int>(parts.size());
    parts.push_back({start});
    held.push_back(0);
    part_of[static_cast<std::size_t>(start)] = part;
    for (std::size_t i = 0; i < parts.back().size(); ++i) {
      const int triangle = parts.back()[i];
      if (is_held(triangle)) held.back() = 1;
      for (const int edge : HalfEdges::sides(triangle)) {
        if (held.back()) break;
        const int beyond = neighbour(edge);
        if (beyond == HalfEdges::none) continue;
        int& other = part_of[static_cast<std::size_t>(beyond)];
        if (other >= 0 && other != part) held.back() = held[static_cast<std::size_t>(other)];
        if (other < 0) parts.back().push_back(beyond);
        if (other < 0) other = part;
      }
      if (held.back()) return;  // the rest of it need not be seen
    }
  };
  for (const int triangle : starts)
    if (part_of[static_cast<std::size_t>(triangle)] < 0) search(triangle);
  std::vector<std::vector<int>> loose;
  for (std::size_t i = 0; i < parts.size(); ++i)
    if (!held[i]) loose.push_back(std::move(parts[i]));
  return loose;
}

}  // namespace topple::fracture
