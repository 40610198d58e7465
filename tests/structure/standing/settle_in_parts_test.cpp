// A frame that is brought up to date in parts, as a budget of operations makes it, against one that is at once.
#include <catch2/catch.hpp>

#include "structure/frame_builder.h"
#include "topple/structure/standing_frame.h"

namespace {

using namespace topple::test;

FrameBuilder weak_grid() {
  FrameBuilder f = grid_building(4, 3, 3, 5, 3, same_capacity(4e5), same_capacity(6e4));
  for (std::size_t m = 0; m < f.building.members.size(); ++m) f.load(MemberId(m), -4000);
  return f;
}

struct Collapse {
  std::vector<JointId> broken;
  std::vector<MemberId> left;
  int calls = 0, answering = 0;
};

Collapse collapse(StandingFrame& frame, double operations) {
  for (const std::size_t member : {0u, 1u, 4u}) frame.remove(MemberId(member));
  Collapse result;
  while (frame.pending()) {
    for (const JointBreak& one : frame.settle(1000, operations)) result.broken.push_back(one.joint);
    for (const Detached& part : frame.take_detached())
      result.left.insert(result.left.end(), part.members.begin(), part.members.end());
    ++result.calls;
    result.answering += frame.answering() ? 1 : 0;
    REQUIRE(result.calls < 100000);
  }
  return result;
}

}  // namespace

TEST_CASE("a collapse in parts breaks the same joints in the same order, and ends in the same bits") {
  const FrameBuilder f = weak_grid();
  StandingFrame at_once(f.building, CombinationId(0u), {}), in_parts(f.building, CombinationId(0u), {});
  const Collapse whole = collapse(at_once, unlimited), parts = collapse(in_parts, 1e5);
  REQUIRE(whole.broken.size() >= 5);
  CHECK(whole.calls == 1);
  CHECK(parts.calls >= 10);
  CHECK(parts.answering >= 5);
  CHECK(parts.broken == whole.broken);
  CHECK(parts.left == whole.left);
  for (std::size_t n = 0; n < f.building.nodes.size(); ++n)
    CHECK(in_parts.displacement(NodeId(n)) == at_once.displacement(NodeId(n)));
  CHECK(in_parts.energy().freed == Approx(at_once.energy().freed).epsilon(1e-12));
}

TEST_CASE("what breaks at an impact is left to the next settle when it is only begun") {
  FrameBuilder f;
  const NodeId a = f.node("A", 0, 0, 0), b = f.node("B", 4, 0, 0), c = f.node("C", 8, 0, 0);
  const MemberId ab = f.member("AB", MemberKind::beam, a, b, same_capacity(1e9), same_capacity(1e9));
  const MemberId bc = f.member("BC", MemberKind::beam, b, c, same_capacity(1e9), same_capacity(1e9));
  f.support(a);
  f.support(c);
  f.load(ab, -1000);
  f.load(bc, -1000);
  StandingFrame frame(f.building, CombinationId(0u), {});
  const JointId far = f.building.joint(bc, 1);
  const Vec6 before = frame.demand(f.building.joint(ab, 0));
  JointBreak broken;
  broken.joint = far;
  frame.begin_break_in_impact(std::vector{broken});
  CHECK(frame.answering());
  CHECK(frame.pending());
  CHECK_FALSE(frame.intact(far));
  CHECK(frame.stands(bc));
  CHECK(frame.demand(f.building.joint(ab, 0)) == before);
  CHECK(frame.settle(10).empty());  // who broke it has told of it
  CHECK_FALSE(frame.answering());
  // Cantilever of 8 m: q L^2 / 2 about its root.
  CHECK(frame.demand(f.building.joint(ab, 0)).tail<3>().norm() == Approx(1000 * 8 * 8 / 2.0).epsilon(1e-9));
}
