#pragma once
// A member in pieces that hold together rigidly, so that it can be cut inside.
#include <utility>
#include <vector>

#include "topple/structure/building.h"

namespace topple::structure {

/// Divides a member "M" at fractions of its length from its first end (each above 0 and below 1, ascending). The first
/// piece stays "M", later ones are "M/2", "M/3" ... in its groups; place i is the node "M/cut-i", held by the joints
/// "M/cut-i:1" and "M/cut-i:2", which never break under load. The joints "M:1" and "M:2" stay those of the ends.
/// Loads and masses go to the pieces they act on. Joint ids of panels change: divide before anything asks for them.
/// `nodes`: where they lie; none: on the line between the member's nodes. Returns the cuts' first joints. Throws
/// InputError for a name that is taken, std::invalid_argument for other places.
std::vector<JointId> divide_member(Building& building, MemberId member, const std::vector<double>& places,
                                   const std::vector<Vec3>& nodes = {});

/// The same at nodes that are there, each with its fraction of the length; rigid arms reach them from the member's
/// line.
std::vector<JointId> divide_member_at(Building& building, MemberId member,
                                      const std::vector<std::pair<double, NodeId>>& nodes);

/// Every member in `pieces` of the same length, for natural modes: one element hides a member's own swing.
void divide_all_members(Building& building, int pieces);

}  // namespace topple::structure
