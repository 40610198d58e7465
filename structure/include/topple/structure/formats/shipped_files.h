#pragma once
// Names of the models and scenarios that come with the library, as find_model and find_scenario take them.
#include <string>
#include <vector>

namespace topple::structure {

/// In alphabetical order, each once, from all places that find_model looks in.
[[nodiscard]] std::vector<std::string> shipped_models();
[[nodiscard]] std::vector<std::string> shipped_scenarios();

}  // namespace topple::structure
