#pragma once
// Strengths of materials changed in a model's text, so that all that follows from them (capacities derived from
// sections, cracking, design checks) follows anew when it is read.
#include <string>
#include <vector>

namespace topple::structure {

/// One material's strengths times a factor.
struct MaterialChange {
  std::string material;  ///< its name in the model
  double strength = 1;   ///< multiplies yield, compressive and tensile strength, as far as the material has them
};

/// `model`: a model as JSON (convert_model makes it of the other forms). All else keeps its value to the bit. Throws
/// InputError for a material that the model has not, or a multiplier that is not above 0 and finite.
[[nodiscard]] std::string model_with_strengths(const std::string& model, const std::vector<MaterialChange>& changes);

}  // namespace topple::structure
