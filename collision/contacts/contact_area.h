#pragma once
// The area in which two convex parts touch, from what GJK gives: one point.
#include "contacts/first_touch.h"

namespace topple::collision {

/// Vertices nearer to the plane of contact than this (m) count as touching it: a slab that falls almost flat hits flat.
inline constexpr double kContactBand = 0.005;

/// Fills corners, their count and the point of a touch whose normal and point are those of the closest points.
void find_contact_area(const SolidPart& first, const btTransform& first_pose, const SolidPart& second,
                       const btTransform& second_pose, Touch& touch);
/// Centre of a polygon's area, of its corners when it has none, and at most four of its points that span the most.
void set_contact_area(const btAlignedObjectArray<btVector3>& polygon, Touch& touch);

}  // namespace topple::collision
