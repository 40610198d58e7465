#pragma once
// Numbers and values of samples as JSON text.
#include <string>

#include "topple/structure/study/study.h"

namespace topple::structure::study {

/// The shortest text that reads back to the same bits; "null" for what is no finite number.
[[nodiscard]] std::string number_text(double number);
/// As JSON.
[[nodiscard]] inline std::string text_of(const StudyValue& value) {
  return value.is_number() ? number_text(value.number) : value.json;
}
/// FNV-1a over bytes, going on from `hash` (G. Fowler, L. C. Noll, K.-P. Vo).
[[nodiscard]] constexpr std::uint64_t fnv1a(std::string_view bytes, std::uint64_t hash = 0xcbf29ce484222325) {
  for (const char byte : bytes) hash = (hash ^ static_cast<unsigned char>(byte)) * 0x100000001b3;
  return hash;
}
/// Sixteen digits.
[[nodiscard]] std::string hexadecimal(std::uint64_t value);

}  // namespace topple::structure::study
