#pragma once
// Cells that a spreadsheet would take for a formula ("=cmd", "+A1", "-x", "@f") get an apostrophe before them when they
// are written, which a spreadsheet takes for the mark of a text, and lose it when they are read. Numbers are none.
#include <string>
#include <string_view>

#include "topple/structure/number_range.h"

namespace topple::structure::formats {

/// Behind any apostrophes stands what begins a formula.
[[nodiscard]] inline bool looks_like_formula(std::string_view text) {
  const std::size_t first = text.find_first_not_of('\'');
  if (first == std::string_view::npos) return false;
  const char c = text[first];
  return (c == '=' || c == '+' || c == '-' || c == '@') && !number_of(text.substr(first));
}
[[nodiscard]] inline std::string guarded(std::string_view text) {
  return looks_like_formula(text) ? "'" + std::string(text) : std::string(text);
}
/// What guarded() was given.
[[nodiscard]] inline std::string_view unguarded(std::string_view cell) {
  return cell.starts_with('\'') && looks_like_formula(cell) ? cell.substr(1) : cell;
}

}  // namespace topple::structure::formats
