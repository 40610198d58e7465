#pragma once
// What stands knows a shell panel by nodes of the building. Where members or other shells lie along a panel's edge,
// each node of the mesh there becomes one: members are divided at it, with rigid joints that never break, so that panel
// and members move together as in an analysis of the whole mesh.
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "topple/structure/building.h"

namespace topple::structure {

/// By name of a member: fractions of its length, ascending, above 0 and below 1.
using MemberPlaces = std::map<std::string, std::set<double>>;
/// The same with the name of the joint at each place (divide_member.h): breaking it cuts the member there.
using MemberCuts = std::map<std::pair<std::string, double>, std::string>;

/// Divides members at `cuts` and at the nodes of the meshes along their edges, and fills Panel::edge_nodes and
/// Panel::joined. Nodes on an edge without members are named by the edge's joint: `W:2/1`, `W:2/2` and so on. Throws
/// InputError where a name is taken. A building that was readied stays as it is.
MemberCuts join_shells(Building& building, const MemberPlaces& cuts = {});

}  // namespace topple::structure
