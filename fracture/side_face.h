#pragma once
// The four vertices of a side face of a panel, for every mesh that has some.
#include "topple/fracture/mesh.h"

namespace topple::fracture {

/// Writes the side over the edge from a to b, the solid on its left, to four vertices from `first` on and returns its
/// two triangles.
inline std::array<std::array<int, 3>, 2> write_side(Mesh& mesh, int first, const Vec2& a, const Vec2& b,
                                                    double thickness) {
  const Vec2 along = (b - a).normalized();
  const Vec3 normal(along.y(), -along.x(), 0);
  int vertex = first;
  for (const double z : {-thickness / 2, thickness / 2})
    for (const Vec2& end : {a, b}) {
      const auto i = static_cast<std::size_t>(vertex++);
      mesh.positions[i] = Vec3(end.x(), end.y(), z);
      mesh.normals[i] = normal;
      mesh.texture[i] = Vec2(along.dot(end), z);
    }
  return {{{first, first + 1, first + 3}, {first, first + 3, first + 2}}};
}

}  // namespace topple::fracture
