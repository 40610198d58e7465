#pragma once
// A solid with the shapes that our own search for contacts reads, and where it is.
#include "contacts/manifold.h"
#include "shapes/polyhedron.h"
#include "shapes/solid.h"

namespace topple::collision {

struct TouchingSolid : Solid {
  std::vector<PartShape> shapes;  ///< of its parts, in its frame
  Placement at;
};

/// From the parts of the solid (make_parts) and what they were made from.
void make_shapes(const std::vector<ConvexPart>& description, TouchingSolid& solid);

}  // namespace topple::collision
