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

/// Divides every member that is one beam and carries both signs into `pieces` of the same length, at nodes of the frame
/// behind all others; everything else keeps its number. Returns, per member, these nodes. Throws InputError where a
/// node of the building has the name ("M/cut-1" ...) that results give one of them.
std::vector<std::vector<int>> divide_evenly(const Building& building, int pieces, Frame& frame);

/// Adds supports of panel edges: one at each mesh node of the edge.
void add_edge_supports(const Building& building, Frame& frame);

}  // namespace topple::structure
