#pragma once
// Deterministic changes of a text, for readers that must stand whatever they are given.
#include <random>
#include <span>
#include <string>
#include <string_view>

namespace topple::test {

/// Rounds of a fuzz test; scripts/stress readers makes more of them under the sanitizers.
inline constexpr int fuzz_rounds = 2000;

/// One to three random changes: a character, a piece dropped or moved over another, a cell between two of `separators`
/// replaced by one of `values`, the end cut off.
inline std::string mutated(std::string text, std::mt19937& random, std::string_view separators,
                           std::span<const char* const> values) {
  const auto below = [&](std::size_t n) { return n == 0 ? 0 : static_cast<std::size_t>(random() % n); };
  for (std::size_t changes = 1 + below(3); changes > 0; --changes) {
    if (text.empty()) text = "x";
    switch (below(7)) {
      case 0:
        text[below(text.size())] = static_cast<char>(random() % 256);
        break;
      case 1:
        text[below(text.size())] = "{}[]\",:;0123456789.-+eE# \n\ttrue"[below(31)];
        break;
      case 2:
        text.erase(below(text.size()), below(30));
        break;
      case 3:
        text.insert(below(text.size()), text.substr(below(text.size()), below(60)));
        break;
      case 4:
        if (below(4) == 0) text.resize(below(text.size()));
        break;
      default: {
        const std::size_t at = text.find_first_of(separators, below(text.size()));
        if (at == std::string::npos) break;
        const std::size_t end = text.find_first_of(separators, at + 1);
        if (end == std::string::npos) break;
        text.replace(at + 1, end - at - 1, values[below(values.size())]);
      }
    }
  }
  return text;
}

}  // namespace topple::test
