#pragma once
// Random numbers that are a function of a key and a counter, without any state: Philox4x32-10 (J. K. Salmon, M. A.
// Moraes, R. O. Dror, D. E. Shaw, Parallel random numbers: as easy as 1, 2, 3, SC'11, 2011).
#include <array>
#include <cstdint>

namespace topple::structure::study {

using Words = std::array<std::uint32_t, 4>;

/// The block of four words at `counter` of the stream `key`.
[[nodiscard]] constexpr Words philox(Words counter, std::array<std::uint32_t, 2> key) {
  constexpr std::uint64_t multiply_0 = 0xD2511F53, multiply_1 = 0xCD9E8D57;
  constexpr std::uint32_t weyl_0 = 0x9E3779B9, weyl_1 = 0xBB67AE85;
  for (int round = 0; round < 10; ++round) {
    const std::uint64_t a = multiply_0 * counter[0], b = multiply_1 * counter[2];
    counter = {static_cast<std::uint32_t>(b >> 32) ^ counter[1] ^ key[0], static_cast<std::uint32_t>(b),
               static_cast<std::uint32_t>(a >> 32) ^ counter[3] ^ key[1], static_cast<std::uint32_t>(a)};
    key[0] += weyl_0;
    key[1] += weyl_1;
  }
  return counter;
}

/// What a number is drawn for: different purposes of one seed have nothing to do with each other.
enum class Drawn : std::uint32_t { sample = 1, order, shift, bootstrap, search };

/// 64 random bits for the index `k` of the thing `which`.
[[nodiscard]] constexpr std::uint64_t random_bits(std::uint64_t seed, Drawn purpose, std::uint64_t k,
                                                  std::uint32_t which) {
  const Words words = philox(
      {static_cast<std::uint32_t>(k), static_cast<std::uint32_t>(k >> 32), which, static_cast<std::uint32_t>(purpose)},
      {static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)});
  return (std::uint64_t{words[1]} << 32) | words[0];
}

/// Uniform above 0 and below 1: the middle of one of 2^52 equal parts.
[[nodiscard]] constexpr double unit_interval(std::uint64_t bits) {
  return (static_cast<double>(bits >> 12) + 0.5) * 0x1p-52;
}

}  // namespace topple::structure::study
