#include "formats/json/shortest_number.h"

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>

namespace topple::structure {

namespace {

using Wide = unsigned __int128;

constexpr int least_power = -292, greatest_power = 324;
struct Power {
  std::uint64_t high = 0, low = 0;
};
using Powers = std::array<Power, greatest_power - least_power + 1>;

/// A large whole number, least word first.
template <std::size_t Words>
struct Large {
  std::array<std::uint64_t, Words> word{};

  constexpr void multiply_by_ten() {
    std::uint64_t carry = 0;
    for (std::uint64_t& w : word) {
      const Wide product = static_cast<Wide>(w) * 10 + carry;
      w = static_cast<std::uint64_t>(product);
      carry = static_cast<std::uint64_t>(product >> 64);
    }
  }
  constexpr void divide_by_ten() {
    std::uint64_t rest = 0;
    for (std::size_t i = Words; i-- > 0;) {
      const Wide part = (static_cast<Wide>(rest) << 64) | word[i];
      word[i] = static_cast<std::uint64_t>(part / 10);
      rest = static_cast<std::uint64_t>(part % 10);
    }
  }
  /// The leading 128 bits, rounded up; `exact`: nothing has been cut off below the last word.
  [[nodiscard]] constexpr Power leading(bool exact) const {
    std::size_t top = Words - 1;
    while (word[top] == 0) --top;
    const int shift = std::countl_zero(word[top]);
    const auto at = [&](std::size_t below) { return below <= top ? word[top - below] : 0; };
    const auto shifted = [&](std::size_t below) {
      return shift == 0 ? at(below) : at(below) << shift | at(below + 1) >> (64 - shift);
    };
    bool more = !exact || (at(2) << shift) != 0;
    for (std::size_t below = 3; below <= top; ++below) more = more || at(below) != 0;
    const Wide value = ((static_cast<Wide>(shifted(0)) << 64) | shifted(1)) + (more ? 1 : 0);
    return {static_cast<std::uint64_t>(value >> 64), static_cast<std::uint64_t>(value)};
  }
};

/// 10^k, scaled by a power of two to 128 bits and rounded up.
constexpr Powers make_powers() {
  Powers powers;
  Large<18> up;
  up.word[0] = 1;
  for (int k = 0; k <= greatest_power; ++k) {
    powers[static_cast<std::size_t>(k - least_power)] = up.leading(true);
    up.multiply_by_ten();
  }
  Large<20> down;
  down.word.back() = std::uint64_t{1} << 63;
  for (int k = -1; k >= least_power; --k) {
    down.divide_by_ten();
    powers[static_cast<std::size_t>(k - least_power)] = down.leading(false);
  }
  return powers;
}

constexpr Powers powers = make_powers();

constexpr std::array<char, 200> make_pairs() {
  std::array<char, 200> pairs{};
  for (std::size_t i = 0; i < 100; ++i) {
    pairs[2 * i] = static_cast<char>('0' + i / 10);
    pairs[2 * i + 1] = static_cast<char>('0' + i % 10);
  }
  return pairs;
}
constexpr std::array<char, 200> pairs = make_pairs();

/// floor(log2(10^e)), and floor(log10(2^e)) or of three quarters of it, for all exponents of doubles.
constexpr int floor_log2_of_power(int e) { return (e * 1741647) >> 19; }
constexpr int floor_log10_of_power(int e, bool three_quarters) {
  return (e * 1262611 - (three_quarters ? 524031 : 0)) >> 22;
}

/// A product of a power and a factor: 192 bits.
struct Product {
  std::uint64_t high;
  Wide low;
};
Product product(const Power& power, std::uint64_t factor) {
  const Wide lower = static_cast<Wide>(power.low) * factor;
  const Wide upper = static_cast<Wide>(power.high) * factor + static_cast<std::uint64_t>(lower >> 64);
  return {static_cast<std::uint64_t>(upper >> 64), (upper << 64) | static_cast<std::uint64_t>(lower)};
}
/// power x 2^bits, for few bits.
Product shifted(const Power& power, int bits) {
  const Wide whole = (static_cast<Wide>(power.high) << 64) | power.low;
  return {power.high >> (64 - bits), whole << bits};
}
Product sum(const Product& a, const Product& b) {
  const Wide low = a.low + b.low;
  return {a.high + b.high + (low < a.low ? 1 : 0), low};
}
Product difference(const Product& a, const Product& b) {
  return {a.high - b.high - (a.low < b.low ? 1 : 0), a.low - b.low};
}
/// The upper part, its last bit set where anything but the last bit below it lies there.
std::uint64_t round_to_odd(const Product& p) { return p.high | (static_cast<std::uint64_t>(p.low >> 64) > 1 ? 1 : 0); }

struct Decimal {
  std::uint64_t digits;
  int exponent;  ///< of ten, of the last digit
};

Decimal shortest(double number) {
  constexpr int fraction_bits = 52, bias = 1075;
  const auto bits = std::bit_cast<std::uint64_t>(number);
  const std::uint64_t fraction = bits & ((std::uint64_t{1} << fraction_bits) - 1);
  const int raw = static_cast<int>(bits >> fraction_bits);
  const std::uint64_t c = raw == 0 ? fraction : fraction | std::uint64_t{1} << fraction_bits;
  const int q = raw == 0 ? 1 - bias : raw - bias;
  // Below a power of two the neighbour is nearer.
  const bool uneven = fraction == 0 && raw > 1;
  const int k = floor_log10_of_power(q, uneven), h = q + floor_log2_of_power(-k) + 1;
  const Power& power = powers[static_cast<std::size_t>(-k - least_power)];
  const Product at_middle = product(power, (4 * c) << h);
  const std::uint64_t middle = round_to_odd(at_middle);
  // A bound of the interval itself reads back to the number when that is even.
  const std::uint64_t odd = c & 1;
  const std::uint64_t lower = round_to_odd(difference(at_middle, shifted(power, uneven ? h : h + 1))) + odd;
  const std::uint64_t upper = round_to_odd(sum(at_middle, shifted(power, h + 1))) - odd;
  const std::uint64_t s = middle / 4;
  if (s >= 10) {
    const std::uint64_t ten = s / 10;
    const bool below = lower <= 40 * ten, above = 40 * ten + 40 <= upper;
    if (below != above) return {ten + (above ? 1 : 0), k + 1};
  }
  const bool below = lower <= 4 * s, above = 4 * s + 4 <= upper;
  if (below != above) return {s + (above ? 1 : 0), k};
  const std::uint64_t half = 4 * s + 2;
  return {s + (middle > half || (middle == half && (s & 1) != 0) ? 1 : 0), k};
}

/// Eight digits, leading zeros kept.
void write_eight(std::uint32_t number, char* to) {
  const std::uint32_t upper = number / 10000, lower = number % 10000;
  std::memcpy(to, &pairs[static_cast<std::size_t>(upper / 100) * 2], 2);
  std::memcpy(to + 2, &pairs[static_cast<std::size_t>(upper % 100) * 2], 2);
  std::memcpy(to + 4, &pairs[static_cast<std::size_t>(lower / 100) * 2], 2);
  std::memcpy(to + 6, &pairs[static_cast<std::size_t>(lower % 100) * 2], 2);
}

/// 17 digits, leading zeros kept.
void write_digits(std::uint64_t number, char* to) {
  constexpr std::uint64_t eight = 100000000;
  const std::uint64_t upper = number / eight, rest = number - upper * eight, first = upper / eight;
  to[0] = static_cast<char>('0' + first);
  write_eight(static_cast<std::uint32_t>(upper - first * eight), to + 1);
  write_eight(static_cast<std::uint32_t>(rest), to + 9);
}

char* write_exponent(int exponent, char* to) {
  *to++ = 'e';
  *to++ = exponent < 0 ? '-' : '+';
  const auto size = static_cast<std::size_t>(exponent < 0 ? -exponent : exponent);
  if (size >= 100) *to++ = static_cast<char>('0' + size / 100);
  std::memcpy(to, &pairs[size % 100 * 2], 2);
  return to + 2;
}

}  // namespace

char* write_shortest(double number, char* to) {
  auto [value, exponent] = shortest(number);
  while (value % 10 == 0) {
    value /= 10;
    ++exponent;
  }
  // Copies are of a fixed length, which takes no call: what they write too much is written over or lies behind the end.
  constexpr std::size_t most = 24;
  constexpr int digits = 17;
  char text[digits + most + 1] = {};
  write_digits(value, text);
  const char* first = text + (text[0] == '0' ? 1 : 0);
  while (*first == '0') ++first;
  const int count = static_cast<int>(text + digits - first);
  const int point = count + exponent;  // digits before the decimal point
  // Plain where that is not longer than with an exponent.
  if (exponent >= 0 && exponent <= (count == 1 ? 4 : 5)) {
    std::memcpy(to, first, most);
    std::memset(to + count, '0', 8);
    return to + point;
  }
  if (exponent < 0 && point > 0) {
    std::memcpy(to, first, most);
    to[point] = '.';
    std::memcpy(to + point + 1, first + point, most);
    return to + count + 1;
  }
  if (exponent < 0 && -point <= (count == 1 ? 2 : 3)) {
    std::memcpy(to, "0.000", 5);
    to += 2 - point;
    std::memcpy(to, first, most);
    return to + count;
  }
  to[0] = *first;
  to[1] = '.';
  std::memcpy(to + 2, first + 1, most);
  return write_exponent(point - 1, to + (count == 1 ? 1 : count + 1));
}

}  // namespace topple::structure
