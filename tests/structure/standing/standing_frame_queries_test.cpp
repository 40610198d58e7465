// What a standing frame tells of its inner forces, loads and reactions, against the cantilever's closed forms; and
// capacities that change while it stands.
#include <catch2/catch.hpp>

#include "structure/frame_builder.h"
#include "topple/structure/standing_frame.h"

namespace {

using namespace topple::test;

constexpr double length = 4, tip = 1000, spread = 500;  // m, N, N/m: a cantilever along x under both

struct Cantilever {
  FrameBuilder frame;
  NodeId root = frame.node("A", 0, 0, 3), end = frame.node("B", length, 0, 3);
  MemberId beam = frame.member("AB", MemberKind::beam, root, end, same_capacity(1e4), {});
  Cantilever() {
    frame.support(root);
    frame.load(end, (Vec6() << 0, 0, -tip, 0, 0, 0).finished());
    frame.load(beam, -spread);
  }
};

}  // namespace

TEST_CASE("a cantilever's inner forces, loads and reaction are told along it") {
  const Cantilever c;
  const StandingFrame standing(c.frame.building, CombinationId(0u), {});
  const auto forces = standing.internal_forces(c.beam, 4);
  REQUIRE(forces.size() == 5);
  for (int i = 0; i <= 4; ++i) {
    const double left = length * (4 - i) / 4;  // to the tip
    const auto& at = forces[static_cast<std::size_t>(i)];
    // The sag tenses the upper side: about +y where z is up, and the shear on the face that looks along +x is downward.
    CHECK(at[2] == Approx(-(tip + spread * left)).margin(1e-6 * tip));
    CHECK(at[4] == Approx(tip * left + spread * left * left / 2).margin(1e-6 * tip));
    CHECK(at[0] == Approx(0).margin(1e-6 * tip));
  }
  REQUIRE(standing.member_loads(c.beam).size() == 1);
  CHECK(standing.member_loads(c.beam)[0].first(2) == -spread);
  CHECK(standing.node_load(c.end)(2) == -tip);
  CHECK(standing.reaction(0)(2) == Approx(tip + spread * length));
  CHECK(standing.contact_loads().empty());
}

TEST_CASE("a contact load is told while it lies") {
  const Cantilever c;
  StandingFrame standing(c.frame.building, CombinationId(0u), {});
  standing.set_contact_load({7, {c.beam, {}, Vec3(2, 0, 3)}, Vec3(0, 0, -10)});
  standing.settle(1);
  REQUIRE(standing.contact_loads().size() == 1);
  CHECK(standing.contact_loads()[0].force.z() == -10);
  CHECK(standing.reaction(0)(2) == Approx(tip + spread * length + 10));
  standing.remove_contact_load(7);
  CHECK(standing.contact_loads().empty());
}

TEST_CASE("a changed capacity changes the utilisation without a solve, and breaks what is over it") {
  Cantilever c;
  StandingFrame standing(c.frame.building, CombinationId(0u), {});
  const JointId root = c.frame.building.joint(c.beam, 0);
  const double moment = tip * length + spread * length * length / 2;
  CHECK(standing.utilisation(root).value == Approx(moment / 1e4));
  const auto solves = standing.counters().solves;
  const auto set = [&](const JointCapacity& capacity) {
    c.frame.building.joints[static_cast<std::size_t>(root.index)].capacity = capacity;
    standing.capacity_changed(root);
  };
  set(same_capacity(2e4));
  CHECK(standing.utilisation(root).value == Approx(moment / 2e4));
  CHECK(standing.settle(5).empty());
  CHECK(standing.counters().solves == solves);
  set({});  // never breaks ...
  CHECK(standing.utilisation(root).value == 0);
  CHECK(standing.settle(5).empty());
  set(same_capacity(0.9 * moment));  // ... and then does
  CHECK(standing.utilisation(root).value == Approx(1 / 0.9));
  const auto breaks = standing.settle(5);
  REQUIRE(breaks.size() == 1);
  CHECK(breaks[0].joint == root);
  CHECK(breaks[0].sense == Sense::moment_y);
  CHECK_FALSE(standing.stands(c.beam));
  CHECK(standing.internal_forces(c.beam, 4).empty());
  CHECK(standing.member_loads(c.beam).empty());
}

TEST_CASE("a ductile joint yields at the capacity that it is given") {
  Cantilever c;
  const double moment = tip * length + spread * length * length / 2;
  const JointId root = c.frame.building.joint(c.beam, 0);
  JointCapacity& capacity = c.frame.building.joints[static_cast<std::size_t>(root.index)].capacity;
  capacity = same_capacity(10 * moment);
  capacity.ductility[static_cast<std::size_t>(Sense::moment_y)] = 0.01;
  StandingFrame standing(c.frame.building, CombinationId(0u), {});
  CHECK(standing.utilisation(root).value == Approx(0.1));
  capacity.value[static_cast<std::size_t>(Sense::moment_y)] = 0.5 * moment;
  standing.capacity_changed(root);
  CHECK(standing.utilisation(root).value == 1);  // it holds at its capacity until it has turned too far
}
