#include "renderer/shapes/looks.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>
#include <utility>

namespace topple::viewer {
namespace {

/// In any case; asked for each chunk in each picture, so without a copy.
bool holds(std::string_view text, std::string_view word) {
  return std::search(text.begin(), text.end(), word.begin(), word.end(),
                     [](char a, char b) { return std::tolower(static_cast<unsigned char>(a)) == b; }) != text.end();
}

}  // namespace

Look look_of(const structure::Material& material) {
  constexpr std::array<std::pair<const char*, Look>, 10> words{{{"brick", Look::brick},
                                                                {"masonry", Look::brick},
                                                                {"glass", Look::glass},
                                                                {"timber", Look::timber},
                                                                {"wood", Look::timber},
                                                                {"glulam", Look::timber},
                                                                {"plaster", Look::plaster},
                                                                {"gypsum", Look::plaster},
                                                                {"steel", Look::steel},
                                                                {"concrete", Look::concrete}}};
  for (const auto& [word, look] : words)
    if (holds(material.name, word)) return look;
  constexpr double metal_density = 6000, wood_density = 1000;  // kg/m3
  if (material.yield_strength || material.density > metal_density) return Look::steel;
  if (material.density > 0 && material.density < wood_density) return Look::timber;
  return Look::concrete;
}

Rgba look_colour(Look look) {
  const auto number = static_cast<unsigned>(look);
  switch (look) {
    case Look::concrete:
      return rgba(154, 151, 145, number);
    case Look::steel:
      return rgba(112, 62, 52, number);  // red oxide primer
    case Look::brick:
      return rgba(136, 90, 76, number);
    case Look::glass:
      return rgba(46, 66, 70, number);
    case Look::plaster:
      return rgba(206, 197, 180, number);
    case Look::timber:
      return rgba(176, 130, 82, number);
  }
  return rgba(154, 151, 145, number);
}

}  // namespace topple::viewer
