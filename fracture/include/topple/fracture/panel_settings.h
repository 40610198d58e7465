#pragma once
// How a panel breaks: the method and its numbers.
#include <array>
#include <cstdint>
#include <optional>

namespace topple::fracture {

/// Method::local: a star-shaped hole of radial corners around each hit, cut into chunks.
struct LocalDamageSettings {
  std::array<int, 2> points{5, 12};        ///< least and most corners, at least 3
  std::array<double, 2> length{0.3, 0.9};  ///< least and most distance of a corner from the hit, m
  double ring = 0.4;                       ///< chunks longer than this are cut across, m
};

enum class Method { voronoi, quadrilateral, local };

/// How a panel breaks.
struct PanelSettings {
  Method method = Method::voronoi;  ///< which cells a hit breaks
  double cell = 0.5;                ///< voronoi, quadrilateral: size of a cell, m
  std::optional<double> jitter;     ///< 0 to 1; by default 1 for voronoi, 0.5 for quadrilateral
  LocalDamageSettings local;        ///< local
  std::uint64_t seed = 1;           ///< of the pattern of cells: the same seed gives the same cells
};

}  // namespace topple::fracture
