// The parts that damage a standing frame and follow what that sets free, each by itself.
#include <catch2/catch.hpp>

#include "standing/damage/generations.h"
#include "standing/damage/queued_changes.h"
#include "structure/frame_builder.h"

namespace {

using namespace topple::test;

constexpr double length = 6, weight = 1000;  // m; N/m
constexpr double rounding = 1e-9;            // relative, of a solve of 12 equations

/// Two cantilevers side by side, each of two members; `root`: what the joint at the support bears.
FrameBuilder cantilevers(const JointCapacity& root = same_capacity(1e12)) {
  FrameBuilder f;
  for (const double y : {0.0, 4.0}) {
    const NodeId fixed = f.node("R", 0, y, 3), middle = f.node("M", length / 2, y, 3), tip = f.node("T", length, y, 3);
    f.member("RM", MemberKind::beam, fixed, middle, root, same_capacity(1e12));
    f.member("MT", MemberKind::beam, middle, tip);
    f.support(fixed);
  }
  for (std::size_t m = 0; m < 4; ++m) f.load(MemberId(m), -weight);
  return f;
}

struct Parts {
  explicit Parts(const Building& building, const FailureRules& rules = {})
      : state(building, CombinationId(0u), rules, 1),
        breaks(state.parts, state.joints),
        yielding({state.parts, state.components, state.loads, state.in_solver.member_loads(),
                  state.in_solver.held_nodes(), state.statics, state.joints, state.account, rules.sudden,
                  breaks.generation(), [] {}}),
        answers(state, yielding),
        slow(state, answers, yielding, breaks),
        departures(state),
        shells(state, departures),
        damage({state, yielding, breaks, slow, departures, shells}),
        release({state, yielding, breaks, departures, shells, damage}),
        generations({state, yielding, breaks, answers, damage, release}),
        queue(state, damage) {}

  StructuralState state;
  BreakLog breaks;
  YieldingWay yielding;
  JointAnswers answers;
  SlowChanges slow;
  Departures departures;
  ShellDamage shells;
  StandingDamage damage;
  StandingRelease release;
  Generations generations;
  QueuedChanges queue;
};

FailureRules sudden_losses(double factor) {
  FailureRules rules;
  rules.sudden = factor;
  return rules;
}

}  // namespace

TEST_CASE("the log of breaks tells what a joint bears, in the generation that runs, and once") {
  const FrameBuilder f = cantilevers(same_capacity(1e9));
  Parts all(f.building);
  REQUIRE_FALSE(all.generations.start());
  const JointId root = f.building.joint(MemberId(0u), 0);
  all.breaks.next_generation();
  const JointBreak& line = all.breaks.add(root, BreakCause::tool);
  CHECK(line.generation == 1);
  CHECK(line.capacity == 1e9);
  CHECK(line.demand == Approx(weight * length * length / 2).epsilon(rounding));
  CHECK(line.position == Vec3(0, 0, 3));
  CHECK(all.breaks.extract().size() == 1);
  CHECK(all.breaks.extract().empty());
}

TEST_CASE("a joint that breaks is told to segments, statics and joints, and what hung on it leaves with the release") {
  const FrameBuilder f = cantilevers();
  Parts all(f.building);
  REQUIRE_FALSE(all.generations.start());
  const JointId root = f.building.joint(MemberId(0u), 0);
  const int c = all.state.components.of(root), other = all.state.components.of(f.building.joint(MemberId(2u), 0));
  all.damage.break_joint(root, BreakCause::tool);
  CHECK_FALSE(all.state.parts.holds(root));
  CHECK(all.state.statics.changed(c));
  CHECK_FALSE(all.state.statics.changed(other));
  CHECK(all.state.joints.demand(root) == Vec6(Vec6::Zero()));
  CHECK(all.damage.leaves_open());
  CHECK_FALSE(all.departures.any());  // nobody has looked yet
  all.damage.break_joint(root, BreakCause::tool);
  CHECK(all.breaks.extract().size() == 1);  // it was broken already
  all.release.release();
  CHECK_FALSE(all.damage.leaves_open());
  const std::vector<Detached> left = all.departures.extract();
  REQUIRE(left.size() == 1);
  CHECK(left[0].members == std::vector<MemberId>{MemberId(0u), MemberId(1u)});
  CHECK_FALSE(left[0].mechanism);
  CHECK_FALSE(all.state.stands(MemberId(1u)));
  CHECK(all.state.stands(MemberId(2u)));
  CHECK(all.state.in_solver.nodes_of(c) == 0);  // not even the support: nothing is left on it
  CHECK(all.state.in_solver.nodes_of(other) == 3);
}

TEST_CASE("a post that is cut in two leaves with both ends to hang by, told once") {
  FrameBuilder f;
  const NodeId foot = f.node("F", 0, 0, 0), middle = f.node("M", 0, 0, 3), head = f.node("H", 0, 0, 6);
  f.member("low", MemberKind::post, foot, middle);
  const MemberId post = f.member("post", MemberKind::post, middle, head, same_capacity(1e12), same_capacity(1e12));
  f.support(foot);
  f.support(head);
  f.load(middle, (Vec6() << 0, 0, -1000, 0, 0, 0).finished());
  Parts all(f.building);
  REQUIRE_FALSE(all.generations.start());
  all.release.cut_in_two(post, 0.25);
  all.generations.bring_up_to_date();
  all.release.cut_in_two(post, 0.25);  // it stands no more
  const std::vector<JointBreak> told = all.breaks.extract();
  REQUIRE(told.size() == 1);
  CHECK(told[0].cause == BreakCause::buckling);
  CHECK(told[0].inside == 0.25);
  CHECK(told[0].position == Vec3(0, 0, 3.75));
  const std::vector<Detached> left = all.departures.extract();
  REQUIRE(left.size() == 1);
  CHECK(left[0].members == std::vector<MemberId>{post});
  CHECK(left[0].cut == 0.25);
  CHECK(left[0].hinges == std::vector<JointId>{f.building.joint(post, 0), f.building.joint(post, 1)});
}

TEST_CASE("what comes on slowly moves the reference along, what a tool brings does not") {
  const double force = 5000, factor = 2;
  const FrameBuilder f = cantilevers();
  Parts all(f.building, sudden_losses(factor));
  REQUIRE_FALSE(all.generations.start());
  const JointId root = f.building.joint(MemberId(0u), 0), other = f.building.joint(MemberId(2u), 0);
  const double own = weight * length * length / 2, more = force * length;
  const auto moment = [](const Vec6& demand) { return std::abs(demand(4)); };
  REQUIRE(moment(all.answers.demand(root)) == Approx(own).epsilon(rounding));

  REQUIRE(all.state.contacts.set({1, {MemberId(1u), {}, Vec3(length, 0, 3)}, Vec3(0, 0, -force), Vec3::Zero()}));
  all.slow.lay();
  CHECK(moment(all.state.joints.demand(root)) == Approx(own + more).epsilon(rounding));
  CHECK(all.state.joints.reference(root) == all.state.joints.demand(root));

  const NodeId tip = f.building[MemberId(3u)].nodes[1];
  all.queue.add(QueuedChanges::EventLoad{tip, (Vec6() << 0, 0, -force, 0, 0, 0).finished()});
  CHECK_FALSE(all.queue.empty());
  all.queue.act();
  CHECK(all.queue.empty());
  all.generations.bring_up_to_date();
  CHECK(moment(all.state.joints.demand(other)) == Approx(own + more).epsilon(rounding));
  CHECK(moment(all.state.joints.reference(other)) == Approx(own).epsilon(rounding));
  CHECK(all.state.joints.amplified(other).demand == Approx(own + factor * more).epsilon(rounding));
}

TEST_CASE(
    "generations: none where all is borne, one more for each state that breaks joints, and they stop when asked to") {
  const double borne = weight * length * length / 2 * 1.1;
  const FrameBuilder f = cantilevers(same_capacity(borne));
  Parts all(f.building);
  REQUIRE_FALSE(all.generations.start());
  CHECK_FALSE(all.generations.run(10));
  CHECK(all.breaks.generation() == 0);
  const NodeId tip = f.building[MemberId(1u)].nodes[1];
  all.queue.add(QueuedChanges::EventLoad{tip, (Vec6() << 0, 0, -weight, 0, 0, 0).finished()});
  all.queue.act();
  all.generations.bring_up_to_date();
  CHECK(all.generations.run(0));  // more would break
  CHECK(all.breaks.size() == 0);
  CHECK_FALSE(all.generations.run(10));
  CHECK(all.breaks.generation() == 1);
  const std::vector<JointBreak> told = all.breaks.extract();
  REQUIRE(told.size() == 1);
  CHECK(told[0].joint == f.building.joint(MemberId(0u), 0));
  CHECK(told[0].cause == BreakCause::overload);
  CHECK(all.departures.extract().size() == 1);
}
