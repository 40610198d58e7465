#pragma once
// Points of a Sobol sequence: evenly spread over the unit cube, the first 2^n of them in every elementary interval
// alike (I. M. Sobol, On the distribution of points in a cube, 1967), with the direction numbers of Joe and Kuo (2008).
#include <cstdint>

namespace topple::structure::study {

/// The most dimensions that there are direction numbers for.
inline constexpr std::uint32_t sobol_dimensions = 512;
/// Points are numbered below this.
inline constexpr std::uint64_t sobol_points = std::uint64_t{1} << 32;

/// Coordinate `dimension` of point k as 32 bits of a binary fraction.
[[nodiscard]] std::uint32_t sobol_bits(std::uint64_t k, std::uint32_t dimension);

}  // namespace topple::structure::study
