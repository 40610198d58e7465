#pragma once
// Shell panels in the frame: their elements, the nodes they share with each other and with members along their edges,
// and those members divided there.
#include "topple/structure/frame.h"

namespace topple::structure {

/// Adds the mesh of every panel of model shell to the frame, whose nodes and beams are those of the building. Throws
/// InputError, naming the panel, for openings that leave nothing.
void add_shell_panels(const Building& building, Frame& frame);

/// Divides members that run along the edges of shell panels: each becomes beams between the mesh's nodes, tied to them
/// by rigid arms where it is offset. A mesh node over a member's rigid offset is not tied, and a member that carries
/// tension or compression only stays in one piece, free between its ends.
void divide_members(const Building& building, Frame& frame);

/// Adds supports of panel edges: one at each mesh node of the edge.
void add_edge_supports(const Building& building, Frame& frame);

}  // namespace topple::structure
