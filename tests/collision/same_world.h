#pragma once
// Two worlds that went alike.
#include <catch2/catch.hpp>

#include "topple/collision/world.h"

namespace collision_test {

inline bool same_touched(const topple::collision::Touched& a, const topple::collision::Touched& b) {
  return a.kind == b.kind && a.body == b.body && a.obstacle == b.obstacle && a.part_tag == b.part_tag;
}

/// Bodies and what the last step told of contacts: to the bit.
inline void require_same(const topple::collision::World& a, const topple::collision::World& b) {
  using topple::collision::BodyId, topple::collision::BodyState, topple::collision::Contact;
  REQUIRE(a.bodies().size() == b.bodies().size());
  REQUIRE(a.awake_count() == b.awake_count());
  for (const BodyId id : a.bodies()) {
    const BodyState one = a.state(id), other = b.state(id);
    REQUIRE(one.pose.position == other.pose.position);
    REQUIRE(one.pose.orientation.coeffs() == other.pose.orientation.coeffs());
    REQUIRE(one.velocity == other.velocity);
    REQUIRE(one.angular_velocity == other.angular_velocity);
    REQUIRE(one.asleep == other.asleep);
    REQUIRE(a.velocity_when_woken(id) == b.velocity_when_woken(id));
  }
  REQUIRE(a.contacts().size() == b.contacts().size());
  for (std::size_t i = 0; i < a.contacts().size(); ++i) {
    const Contact &one = a.contacts()[i], &other = b.contacts()[i];
    REQUIRE(one.body == other.body);
    REQUIRE(one.part_tag == other.part_tag);
    REQUIRE(same_touched(one.other, other.other));
    REQUIRE(one.normal == other.normal);
    REQUIRE(one.approach_speed == other.approach_speed);
    REQUIRE(one.depth == other.depth);
    REQUIRE(one.thickness == other.thickness);
    REQUIRE(one.corner_count == other.corner_count);
    REQUIRE(one.corners == other.corners);
    REQUIRE(one.impulse == other.impulse);
    REQUIRE(one.moment == other.moment);
    REQUIRE(one.point == other.point);
    REQUIRE(one.work_lost == other.work_lost);
    REQUIRE(one.persistent == other.persistent);
  }
}

}  // namespace collision_test
