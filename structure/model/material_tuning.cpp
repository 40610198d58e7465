#include "topple/structure/material_tuning.h"

#include <cmath>

#include "topple/structure/error.h"
#include "topple/structure/formats/json_tree.h"

namespace topple::structure {

std::string model_with_strengths(const std::string& model, const std::vector<MaterialChange>& changes) {
  if (changes.empty()) return model;
  JsonTree json = JsonTree::parse(model);
  if (json.find("materials") == nullptr || !json["materials"].is_object())
    throw InputError("the model has no materials to change");
  JsonTree& materials = json["materials"];
  for (const MaterialChange& change : changes) {
    if (materials.find(change.material) == nullptr) {
      std::string known;
      for (const auto& [name, unused] : materials.fields()) known += (known.empty() ? "" : ", ") + name;
      throw InputError("material '" + change.material + "': the model has none of this name; accepted: " + known);
    }
    if (!(change.strength > 0) || !std::isfinite(change.strength))
      throw InputError("material '" + change.material + "', strength " + std::to_string(change.strength) +
                       ": accepted is a number above 0");
    JsonTree& material = materials[change.material];
    for (const char* key : {"yield_strength", "compressive_strength", "tensile_strength"})
      if (material.find(key) != nullptr) material[key] = material[key].number() * change.strength;
  }
  return json.dump(2) + "\n";
}

}  // namespace topple::structure
