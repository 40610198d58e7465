#pragma once
// The surface of a four-node panel in its own coordinates: s runs from its first node to the second, t from the first
// to the fourth, both from 0 to 1.
#include <array>

#include "topple/structure/building.h"

namespace topple::structure {

class PanelSurface {
 public:
  PanelSurface(const Building& building, const Panel& panel);

  [[nodiscard]] Vec3 at(const Vec2& st) const;
  /// Local x and y from node 1.
  [[nodiscard]] Vec2 local(const Vec2& st) const;
  /// The other way round.
  [[nodiscard]] Vec2 parameters(const Vec2& local) const;

  [[nodiscard]] const Vec3& corner(std::size_t i) const { return corner_[i % 4]; }
  [[nodiscard]] double edge_length(std::size_t edge) const { return (corner(edge + 1) - corner(edge)).norm(); }
  [[nodiscard]] double size() const { return size_; }

  /// Place on edge i (from its node i to i + 1), `along` from 0 to 1.
  [[nodiscard]] static Vec2 on_edge(std::size_t edge, double along) {
    switch (edge) {
      case 0:
        return {along, 0};
      case 1:
        return {1, along};
      case 2:
        return {1 - along, 1};
      default:
        return {0, 1 - along};
    }
  }
  /// Where an edge's point lies in the direction that the edge follows: s for edges 0 and 2, t for 1 and 3.
  [[nodiscard]] static double line_of(std::size_t edge, double along) { return edge < 2 ? along : 1 - along; }

 private:
  std::array<Vec3, 4> corner_;
  std::array<Vec2, 4> local_;
  double size_ = 0;
};

}  // namespace topple::structure
