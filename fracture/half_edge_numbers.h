#pragma once
// Numbers of half-edges: side i (0 to 2) of a triangle runs from corner i to corner i + 1, the triangle on its left.
// Every fourth number stands for nothing, so that shifts take the place of divisions.
#include <array>
#include <cstddef>

namespace topple::fracture {

struct HalfEdgeNumbers {
  static constexpr int none = -1;
  [[nodiscard]] static constexpr int half(int triangle, int side) { return 4 * triangle + side; }
  [[nodiscard]] static constexpr int triangle_of(int edge) { return edge >> 2; }
  [[nodiscard]] static constexpr int side_of(int edge) { return edge & 3; }
  [[nodiscard]] static constexpr std::array<int, 3> sides(int triangle) {
    return {half(triangle, 0), half(triangle, 1), half(triangle, 2)};
  }
  [[nodiscard]] static constexpr int next(int edge) { return (edge & 3) == 2 ? edge - 2 : edge + 1; }
  [[nodiscard]] static constexpr int previous(int edge) { return (edge & 3) == 0 ? edge + 2 : edge - 1; }
  [[nodiscard]] static constexpr std::size_t index(int i) { return static_cast<unsigned>(i); }
};

}  // namespace topple::fracture
