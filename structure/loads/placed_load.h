#pragma once
// A force somewhere on a standing part, as loads on members.
#include "loads/frame_loads.h"

namespace topple::structure {

/// On a member: a point load at the nearest point of its axis. On a panel: the lever rule between two opposite edges
/// that hold, across the shorter span where both pairs do; there `bending_compliance` is that of a simply supported
/// strip, x^2 (L - x)^2 / (3 E' I L) with E' = E/(1 - nu^2) and the effective width 2.4 x (1 - x/L) that slab design
/// gives a point load at x (not below the thickness, not above the panel's width).
[[nodiscard]] PlacedLoad load_at_place(const Building& building, const PanelBearings& bearings,
                                       const ContactPlace& place, const Vec3& force, const Vec3& moment = Vec3::Zero());

/// m/N: by how much a panel that nothing holds bends under a force at a point along its direction, as the strip across
/// its shorter span does (above). Zero at its edges.
[[nodiscard]] double panel_bending_compliance(const Building& building, PanelId panel, const Vec3& point,
                                              const Vec3& direction);

/// Distance of the point of a member's axis nearest to `point` from its first end, within the member.
[[nodiscard]] double nearest_on_axis(const Building& building, MemberId member, const Vec3& point);
[[nodiscard]] Vec3 on_axis(const Building& building, MemberId member, double distance);

}  // namespace topple::structure
