#pragma once
// What is near becomes one, what lies on a member is joined to it: the model format's `connect`.
#include "topple/structure/building.h"

namespace topple::structure {

struct Connections {
  std::size_t merged = 0, divided = 0;  ///< nodes that went into others, members in pieces
};

/// Nodes within `tolerance` (m) of an earlier one become that one, supports, loads and masses with them; then every
/// member that carries tension and compression is divided at the nodes within `tolerance` of it, into the pieces M,
/// M/2, M/3 ... of divide_member.h, each straight between its nodes. Effective lengths that are given for the whole
/// stay those of the pieces. Before anything asks for ids. Throws InputError for members and panels that are not longer
/// than the tolerance, and for pieces whose names are taken.
Connections connect_parts(Building& building, double tolerance);

}  // namespace topple::structure
