#pragma once
// Edges of shell panels whose joint has `stiffness`: the panel's side of a joint moves against the nodes that it hangs
// on, freely where the joint is released, against a spring where it has one, not at all elsewhere.
#include "topple/structure/frame.h"

namespace topple::structure {

/// To be called last, when members are divided and edges supported. Each mesh node at which such a joint gives gets a
/// node for the panel's side, whose six freedoms are its motion against the node on the other side in axes of its own:
/// those that the joint holds are supports, so that they are held exactly, and its elements become patches in these
/// freedoms. PanelMesh names the nodes of the panel's side from then on.
void add_semi_rigid_edges(const Building& building, Frame& frame);

}  // namespace topple::structure
