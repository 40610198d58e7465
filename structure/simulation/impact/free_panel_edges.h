#pragma once
// What the edges of a panel bear that comes down with a body: along each edge, members and nodes of the body hold it
// back or push it on, and it pushes with what hits it and with its inertia.
#include <array>
#include <functional>
#include <optional>
#include <span>

#include "topple/structure/building.h"

namespace topple::structure {

/// Of a panel whose edges can break in flight: along which length each edge still holds, m (0: it does not). None for a
/// panel that goes wherever most of its corners go.
using FreePanelEdges = std::function<std::optional<std::array<double, 4>>(PanelId)>;

/// A force on a panel, at the place and in the axes of the undeformed building.
struct PanelPush {
  Vec3 point = Vec3::Zero(), force = Vec3::Zero();
};

/// Per edge: what holds it does to the panel, per length, in the axes of the edge, so that the panel is in balance with
/// the pushes; zero for an edge that does not hold. Mean force over the edge and moment about its middle of a rigid
/// panel whose edges give alike, in all directions, along their length and over the panel's thickness.
[[nodiscard]] std::array<Vec6, 4> free_panel_edge_demands(const Building& building, PanelId panel,
                                                          const std::array<double, 4>& length,
                                                          std::span<const PanelPush> pushes);

}  // namespace topple::structure
