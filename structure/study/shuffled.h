#pragma once
// A permutation of 0 ... n - 1 that is a function of a key, without a table: a Feistel network over the next power of
// four whose steps are walked until they fall below n (J. Black and P. Rogaway, Ciphers with arbitrary finite domains,
// CT-RSA 2002).
#include <bit>
#include <cstdint>

#include "study/counter_random.h"

namespace topple::structure::study {

/// Where `i` goes, i < n.
[[nodiscard]] constexpr std::uint64_t shuffled(std::uint64_t i, std::uint64_t n, std::uint64_t seed,
                                               std::uint32_t which) {
  if (n < 2) return i;
  constexpr std::uint32_t rounds = 6;
  const int half = (std::bit_width(n - 1) + 1) / 2;
  const std::uint64_t mask = (std::uint64_t{1} << half) - 1;
  do {
    std::uint64_t left = i >> half, right = i & mask;
    for (std::uint32_t round = 0; round < rounds; ++round) {
      const std::uint64_t mixed = random_bits(seed, Drawn::order, (right << 3) | round, which) & mask;
      const std::uint64_t next = left ^ mixed;
      left = right;
      right = next;
    }
    i = (left << half) | right;
  } while (i >= n);
  return i;
}

}  // namespace topple::structure::study
