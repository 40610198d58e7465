#pragma once
// What a part is made of, as it is drawn.
#include "renderer/shapes/palette.h"
#include "topple/structure/building.h"

namespace topple::viewer {

/// The numbers are those that surface_of in renderer/glsl/materials.cpp tells materials apart by. They travel as the
/// alpha of a part's base colour; 255, a full alpha, is a colour without any material.
enum class Look : unsigned { concrete = 1, steel, brick, glass, plaster, timber };

/// By the material's name where that says it ("brick", "masonry", "glass", "timber", "wood", "plaster", "steel",
/// "concrete" in it, in any case), else by its numbers: steel has a yield strength or a density above 6,000 kg/m3,
/// timber a density below 1,000 kg/m3; all else is concrete.
[[nodiscard]] Look look_of(const structure::Material& material);
/// Its colour, with its number as alpha.
[[nodiscard]] Rgba look_colour(Look look);

}  // namespace topple::viewer
