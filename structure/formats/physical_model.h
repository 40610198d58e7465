#pragma once
#include "topple/structure/building.h"

namespace topple::structure::formats {

/// A building that is to fall has to be one: throws InputError, naming the thing, for sizes, materials, loads and
/// capacities that physics has no use for (number_range.h), which an analysis may still be asked about.
void require_physical(const Building& building);

}  // namespace topple::structure::formats
