#pragma once
// Contacts between two convex polyhedra: the axis along which they are farthest apart, or least inside each other,
// among the normals of both and the cross products of their edges (Gottschalk 1996; pairs of edges that make no face of
// the Minkowski difference are left out by their Gauss maps, Gregorius, GDC 2013), then the one face clipped by the
// other.
#include "contacts/manifold.h"
#include "shapes/polyhedron.h"

namespace topple::collision {

/// The last axis that was found, tried first: two that were apart along it mostly still are.
struct SeparatingAxis {
  enum class Kind : std::uint8_t { none, first_face, second_face, edges };
  Kind kind = Kind::none;
  int first = 0, second = 0;  ///< face, or edge of each
  double gap = 0;             ///< along it when it was last measured, m; negative inside
};
template <class Archive>
void serialize(Archive& archive, SeparatingAxis& of) {
  auto& [kind, first, second, gap] = of;
  archive(kind, first, second, gap);
}

/// Fills points (separation below `margin`, the deepest always among them) and normal; none when they are farther
/// apart. Impulses are not touched.
void collide(const Polyhedron& first, const Placement& first_at, const Polyhedron& second, const Placement& second_at,
             double margin, SeparatingAxis& axis, Manifold& manifold);

}  // namespace topple::collision
