#include "study/sobol_sequence.h"

#include <array>
#include <bit>
#include <vector>

namespace topple::structure::study {

namespace {

constexpr std::uint16_t published[] = {
#include "study/sobol_directions.inc"
};

using Directions = std::array<std::uint32_t, 32>;

/// V_i = m_i 2^-i by the recurrence of the primitive polynomial (Joe and Kuo, equation 3), as 32-bit fractions.
Directions directions_of(const std::uint16_t* row) {
  const int degree = std::bit_width(unsigned{row[0]}) - 1;
  Directions v{};
  for (int i = 0; i < 32; ++i) {
    if (i < degree) {
      v[static_cast<std::size_t>(i)] = std::uint32_t{row[1 + i]} << (31 - i);
      continue;
    }
    const std::uint32_t back = v[static_cast<std::size_t>(i - degree)];
    std::uint32_t next = back ^ (back >> degree);
    for (int j = 1; j < degree; ++j)
      if ((row[0] >> (degree - j)) & 1) next ^= v[static_cast<std::size_t>(i - j)];
    v[static_cast<std::size_t>(i)] = next;
  }
  return v;
}

std::vector<Directions> all_directions() {
  std::vector<Directions> all(1);
  for (std::size_t i = 0; i < 32; ++i) all[0][i] = std::uint32_t{1} << (31 - i);  // the first: van der Corput's
  for (const std::uint16_t* row = std::begin(published); row != std::end(published);
       row += std::bit_width(unsigned{*row}))
    all.push_back(directions_of(row));
  return all;
}

}  // namespace

std::uint32_t sobol_bits(std::uint64_t k, std::uint32_t dimension) {
  static const std::vector<Directions> all = all_directions();
  std::uint32_t bits = 0;
  for (std::size_t i = 0; k != 0; ++i, k >>= 1)
    if (k & 1) bits ^= all[dimension][i];
  return bits;
}

}  // namespace topple::structure::study
