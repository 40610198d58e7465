#include "topple/structure/material_tuning.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "topple/structure/error.h"

namespace topple::structure {

std::string model_with_strengths(const std::string& model, const std::vector<MaterialChange>& changes) {
  if (changes.empty()) return model;
  auto json = nlohmann::ordered_json::parse(model, nullptr, false);
  if (!json.is_object() || !json.contains("materials")) throw InputError("the model has no materials to change");
  auto& materials = json["materials"];
  for (const MaterialChange& change : changes) {
    if (!materials.contains(change.material)) {
      std::string known;
      for (const auto& [name, unused] : materials.items()) known += (known.empty() ? "" : ", ") + name;
      throw InputError("material '" + change.material + "': the model has none of this name; accepted: " + known);
    }
    if (!(change.strength > 0) || !std::isfinite(change.strength))
      throw InputError("material '" + change.material + "', strength " + std::to_string(change.strength) +
                       ": accepted is a number above 0");
    auto& material = materials[change.material];
    for (const char* key : {"yield_strength", "compressive_strength", "tensile_strength"})
      if (material.contains(key)) material[key] = material[key].get<double>() * change.strength;
  }
  return json.dump(2) + "\n";
}

}  // namespace topple::structure
