#pragma once
// Weight of drawn meshes that have a density.
#include <filesystem>

#include "topple/structure/building.h"

namespace topple::structure {

/// Adds the mass of the `meshes` of the building's file that have a density above 0 to the members and panels that
/// carry them: each of these gets a material of its own, denser by what its share of the mesh weighs over its own
/// volume, so that weight, mass and inertia are those of both. A mesh that is bound by name is carried by that part;
/// else each part's share is that of the surface that lies nearest to it.
/// Throws InputError, naming the mesh, for one that is not closed.
void add_drawn_weight(Building& building, const std::filesystem::path& file);

}  // namespace topple::structure
