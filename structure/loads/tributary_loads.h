#pragma once
// What a membrane or cladding panel hands on when it is broken in part.
#include "topple/structure/frame.h"

namespace topple::structure {

/// As tributary_loads() of frame.h. `holes`: convex polygons, apart from each other, that were broken out (panel axes
/// from node 1); a two-way panel with holes hands each point's load to both pairs of edges by the lever rule, the pairs
/// sharing it as they do when it is whole, so that a small hole changes little.
[[nodiscard]] TributaryLoads tributary_loads_of_broken(const Building& building, const EdgeMembers& edges,
                                                       PanelId panel, const PanelAction& action,
                                                       const std::array<bool, 4>& edge_holds,
                                                       const std::vector<bool>& member_stands,
                                                       const std::vector<std::vector<Vec2>>& holes);

}  // namespace topple::structure
