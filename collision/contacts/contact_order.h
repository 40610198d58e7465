#pragma once
// An order of contacts: by the parts that they are between.
#include <tuple>

#include "shapes/solid.h"
#include "topple/collision/world.h"

namespace topple::collision {

/// By ids, then by tags: the order of the contacts of a world.
inline auto parts_of(const Contact& c) {
  return std::make_tuple(c.body.value, c.other.kind, c.other.body.value, c.other.obstacle.value, c.part_tag,
                         c.other.part_tag);
}
[[nodiscard]] inline bool before_by_parts(const Contact& a, const Contact& b) { return parts_of(a) < parts_of(b); }
[[nodiscard]] inline bool same_parts(const Contact& a, const Contact& b) { return parts_of(a) == parts_of(b); }

[[nodiscard]] inline Touched touched(const Solid& solid, std::int64_t tag) {
  Touched result;
  result.kind = solid.kind;
  if (solid.kind == Touched::Kind::body) result.body.value = solid.id;
  if (solid.kind == Touched::Kind::obstacle) result.obstacle.value = solid.id;
  result.part_tag = tag;
  return result;
}

}  // namespace topple::collision
