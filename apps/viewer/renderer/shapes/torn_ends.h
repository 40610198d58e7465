#pragma once
// What reinforced concrete looks like where it was torn: rough, with bars that stick out. How it looks alone: nothing
// of it acts.
#include "renderer/shapes/mesh.h"

namespace topple::viewer {

inline constexpr unsigned torn_end_variants = 3;
/// Vertex::broken of bars: they are drawn as rusty steel whatever their mesh is made of.
inline constexpr float bar_mark = 2;

/// Before a member's end, which lies in the plane x = 0 and looks along +x: a rough face up to a third as high as the
/// section is thin, and bent bars in its corners (in the middles of its sides too from 0.45 m on).
[[nodiscard]] Mesh torn_end_mesh(const structure::Section& section, unsigned variant);

/// Adds bars to the torn faces of a piece of concrete (mark_broken comes first), one for each 0.04 m2 or so of these
/// faces, `most` at most: as in a slab of 180 mm with bars each 200 mm.
void add_bars(Mesh& mesh, std::size_t most);

}  // namespace topple::viewer
