// Numbers as text, against the standard library's, which shares nothing with it.
#include "formats/json/shortest_number.h"

#include <bit>
#include <catch2/catch.hpp>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <string>

namespace {

std::string text_of(double number) {
  char text[topple::structure::number_room];
  return {text, topple::structure::write_shortest(number, text)};
}

/// Digits and exponent as the standard library has them: the shortest, and of these the nearest.
std::string scientific(const std::string& text) {
  double number = 0;
  std::from_chars(text.data(), text.data() + text.size(), number);
  char out[64];
  return {out, std::to_chars(out, out + sizeof out, number, std::chars_format::scientific).ptr};
}

/// The text's own digits without point, exponent and outer zeros.
std::string digits(std::string text) {
  text = text.substr(0, text.find('e'));
  std::erase(text, '.');
  text.erase(0, text.find_first_not_of('0'));
  text.erase(text.find_last_not_of('0') + 1);
  return text;
}

/// Empty, or what is wrong with the text of a number.
std::string fault(double number) {
  const std::string text = text_of(number);
  double back = 0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), back);
  if (read.ec != std::errc{} || read.ptr != text.data() + text.size()) return text + " is not one number";
  if (std::bit_cast<std::uint64_t>(back) != std::bit_cast<std::uint64_t>(number))
    return text + " reads back as another";
  if (digits(text) != digits(scientific(text))) return text + " has other digits than " + scientific(text);
  char plain[512];
  const auto length = std::to_chars(plain, plain + sizeof plain, number).ptr - plain;
  if (static_cast<std::ptrdiff_t>(text.size()) > length) return text + " is longer than it has to be";
  return text.size() > topple::structure::longest_number ? text + " is longer than announced" : "";
}

}  // namespace

TEST_CASE("Numbers are written with the least digits that read back to the same bits") {
  std::mt19937_64 random(7);
  for (int i = 0; i < 300000; ++i) {
    const double number = std::abs(std::bit_cast<double>(random()));
    if (!std::isfinite(number) || number == 0) continue;
    const std::string found = fault(number);
    if (!found.empty()) FAIL(found);
  }
  // Such as results are made of.
  std::uniform_real_distribution<double> mantissa(1, 10), exponent(-12, 12);
  for (int i = 0; i < 300000; ++i) {
    const double number = mantissa(random) * std::pow(10, exponent(random));
    const std::string found = fault(number);
    if (!found.empty()) FAIL(found);
  }
  SUCCEED();
}

TEST_CASE("Numbers at the borders of the format, round ones and powers are written right") {
  using Limits = std::numeric_limits<double>;
  for (const double number : {Limits::min(), Limits::max(), Limits::denorm_min(), 2 * Limits::denorm_min(),
                              std::nextafter(Limits::min(), 0), Limits::epsilon(), 9007199254740993.0, 5e-324, 0.3})
    CHECK(fault(number).empty());
  for (int e = -1074; e < 1024; ++e) {
    CHECK(fault(std::ldexp(1.0, e)).empty());
    CHECK(fault(std::nextafter(std::ldexp(1.0, e), Limits::max())).empty());
  }
  for (int e = -307; e < 309; ++e) {
    const double power = std::stod("1e" + std::to_string(e));
    CHECK(fault(power).empty());
    CHECK(fault(power / 7).empty());
  }
  for (int i = 1; i < 20000; ++i) CHECK(fault(i / 8.0).empty());
}

TEST_CASE("Numbers of usual size are written without an exponent") {
  CHECK(text_of(1) == "1");
  CHECK(text_of(12000) == "12000");
  CHECK(text_of(0.25) == "0.25");
  CHECK(text_of(0.00125) == "0.00125");
  CHECK(text_of(100000) == "1e+05");
  CHECK(text_of(1.5e-7) == "1.5e-07");
  CHECK(text_of(210e9) == "2.1e+11");
  CHECK(text_of(1e-300) == "1e-300");
}
