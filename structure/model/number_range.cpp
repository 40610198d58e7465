#include "topple/structure/number_range.h"

#include <charconv>
#include <cmath>

#include "topple/structure/error.h"

namespace topple::structure {

namespace {

/// The shortest text that means this number.
std::string text_of(double value) {
  if (std::isnan(value)) return "nan";
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  char digits[32];
  return {digits, std::to_chars(digits, digits + sizeof digits, value).ptr};
}

}  // namespace

std::string NumberRange::text() const {
  if (above_least) return "a number above " + text_of(least) + ", at most " + text_of(most);
  return "a number from " + text_of(least) + " to " + text_of(most);
}

std::optional<double> number_of(std::string_view text) {
  if (text.starts_with('+')) {
    text.remove_prefix(1);
    if (text.starts_with('-')) return std::nullopt;
  }
  double value = 0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || stop != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

double require_in(const NumberRange& range, double value, std::string_view what) {
  if (!range.contains(value))
    throw InputError(std::string(what) + ": found " + text_of(value) + "; accepted: " + range.text());
  return value;
}

}  // namespace topple::structure
