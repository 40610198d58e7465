#pragma once
// Properties of a cross section from its dimensions. Depth lies along local z, width along y, so Iy is the strong axis
// of an upright I. Each function states the source of its formulas; SI or any consistent unit of length.
#include "topple/structure/building.h"

namespace topple::structure {

/// Fills every property of `section` from its shape and dimensions: area, Iy, Iz, J, shear areas, plastic moduli,
/// torsion modulus and the areas that carry shear at first yield. Shape `numbers` is left as it is.
void compute_properties(Section& section);

/// The areas that carry shear at first yield, from area and dimensions (EN 1993-1-1 6.2.6(3)); apart, so that a
/// catalogue can bring its published area.
void compute_plastic_shear_areas(Section& section);

/// What is wrong with the dimensions (no thickness left, a fillet that does not fit ...); empty: nothing.
[[nodiscard]] std::string dimension_fault(const Section& section);

}  // namespace topple::structure
