#pragma once
// A solid with the shapes that our own search for contacts reads, and where it is.
#include <cmath>

#include "contacts/manifold.h"
#include "shapes/polyhedron.h"
#include "shapes/solid.h"

namespace topple::collision {

struct TouchingSolid : Solid {
  std::vector<PartShape> shapes;  ///< of its parts, in its frame
  Placement at;
  Placement seen;   ///< where it was when it was last asked how far it has come ...
  double gone = 0;  ///< ... in all, and no point of it farther: m, step by step

  /// After it has moved.
  void add_way() {
    gone += (at.position - seen.position).norm() + reach * (at.turn - seen.turn).norm() / std::sqrt(2.0);
    seen = at;
  }

  /// The shapes follow from the parts.
  template <class Archive>
  void serialize(Archive& archive) {
    Solid::serialize(archive);
    archive(at, seen, gone);
  }
};

[[nodiscard]] inline Placement placement_of(const btTransform& at) {
  return {from_bullet(at.getOrigin()), from_bullet(at.getBasis())};
}

/// From the parts of the solid (make_parts).
void make_shapes(TouchingSolid& solid);

}  // namespace topple::collision
