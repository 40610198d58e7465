#pragma once
// Published properties of rolled and hollow sections, by name.
#include <optional>
#include <string_view>

#include "topple/structure/building.h"

namespace topple::structure {

/// The section of that name, SI, or none. Area, Iy, Iz, J and plastic moduli are the published ones as they stand;
/// shear areas, torsion modulus and areas at yield follow from the dimensions. Upper and lower case count as the same,
/// '/' and
/// '-' may be written '_', blanks are left out: "W14x48", "HSS6X4X3/8", "IPE 300".
[[nodiscard]] std::optional<Section> find_in_catalogue(std::string_view name);

}  // namespace topple::structure
