#pragma once
// Pieces of the way from a JSON model to a .3dd file.
#include <algorithm>
#include <initializer_list>
#include <string>
#include <unordered_map>
#include <vector>

#include "formats/frame3dd/frame3dd_file.h"
#include "formats/json/json_document.h"

namespace topple::structure {

namespace frame3dd_model {

[[noreturn]] inline void refuse(const formats::JsonValue& value, const std::string& instead) {
  value.fail("a .3dd file cannot hold it; accepted for it: " + instead);
}

/// Refuses the first key that is not among those.
inline void hold_only(const formats::JsonValue& object, std::initializer_list<std::string_view> keys,
                      const std::string& instead) {
  for (const formats::JsonValue value : object)
    if (std::find(keys.begin(), keys.end(), value.key()) == keys.end()) refuse(value, instead);
}

inline double number_or(const formats::JsonValue& object, const char* key, double otherwise) {
  const auto value = object.find(key);
  return value ? value->number() : otherwise;
}

}  // namespace frame3dd_model

/// What loads of a model need to know of the file's parts, which are there already.
struct Frame3ddNumbers {
  const std::unordered_map<std::string, int>&nodes, &members;  ///< from names; looked up only
  const std::vector<Mat3>& axes;                               ///< by element
  const std::vector<double>& expansion;                        ///< of its material, by element
  double gravity = 1;
};

/// Adds the file's load cases: one for each combination of the model, with the loads of its cases times their factors.
/// Loads in global axes go over as their components along the element's. Throws InputError that names what a .3dd file
/// cannot hold.
void frame3dd_load_cases(const formats::JsonValue& root, const Frame3ddNumbers& numbers, Frame3ddFile& file);

}  // namespace topple::structure
