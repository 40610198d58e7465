#pragma once
// Meshes of shells that say nothing of theirs.
#include "topple/structure/building.h"

namespace topple::structure {

/// Elements along local x and y of a shell whose mesh is to be found by set_usual_meshes().
inline constexpr std::array<int, 2> mesh_not_given{0, 0};

/// Sets the mesh of every shell whose mesh is not given, by its span: that of the panels which go on beyond its edges.
///
/// A panel goes on beyond an edge where one other shell has the same edge, rigidly joined to both, the fold is below 30
/// degrees, and nothing is at the edge that could hold it: no member, support or diaphragm at its nodes. Elements
/// have a twelfth of the shorter span, as square as whole numbers allow: two at least along each side of a panel, 64 at
/// most, and so many that each turns by no more than 2.5 degrees on a surface of folded panels. Twelve elements along a
/// span bend within 3 % of thin plates' series (clamped strips are furthest off), 2.5 degrees within 2 % of the pinched
/// hemisphere (docs/verification.md).
///
/// Throws InputError where the nodes of all meshes are more than 500,000.
void set_usual_meshes(Building& building);

/// An edge beyond which a shell goes on, and the angle there, rad.
struct ShellFold {
  PanelId panel, next;
  double angle = 0;
};
/// Those whose angle is above `least`, each once.
[[nodiscard]] std::vector<ShellFold> shell_folds(const Building& building, double least);

}  // namespace topple::structure
