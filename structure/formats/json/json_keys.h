#pragma once
// Keys of a JSON object that may be absent: read into what holds their defaults.
#include "formats/json/json_document.h"

namespace topple::structure::formats {

/// Keeps the default where the key is absent.
template <class Target, class Read>
void read_optional(const JsonValue& object, std::string_view key, Target& target, Read read) {
  if (const auto value = object.find(key)) target = read(*value);
}

/// Reads a number of a range.
inline auto within(const NumberRange& range) {
  return [range](const JsonValue& value) { return value.in(range); };
}

}  // namespace topple::structure::formats
