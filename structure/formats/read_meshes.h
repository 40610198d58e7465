#pragma once
// The key `meshes` of a model.
#include <map>
#include <string>
#include <vector>

#include "formats/json/json_document.h"

namespace topple::structure::formats {

struct MeshEntry {
  std::string name, file, material;
  double density = 0;                       ///< in the model's units
  std::map<std::string, std::string> bind;  ///< glTF node to member or panel; empty: nearest
};

/// Of a model's root; empty when it has no such key. Names are not looked up.
[[nodiscard]] std::vector<MeshEntry> read_meshes(const JsonValue& root);

}  // namespace topple::structure::formats
