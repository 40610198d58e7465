// The parts that a standing frame is made of, each by itself.
#include <catch2/catch.hpp>

#include "standing/contact_loads.h"
#include "standing/motion/component_damping.h"
#include "standing/yielding_way.h"
#include "structure/frame_builder.h"
#include "topple/structure/frame.h"

namespace {

using namespace topple::test;

constexpr double E = 200e9, Iy = 2e-4;

/// Two cantilevers side by side, each of two members, the second joint of the first members breakable.
FrameBuilder cantilevers(double length) {
  FrameBuilder f;
  for (const double y : {0.0, 4.0}) {
    const NodeId root = f.node("R", 0, y, 3), middle = f.node("M", length / 2, y, 3), tip = f.node("T", length, y, 3);
    f.member("RM", MemberKind::beam, root, middle, same_capacity(1e12), same_capacity(1e12));
    f.member("MT", MemberKind::beam, middle, tip);
    f.support(root);
  }
  for (std::size_t m = 0; m < 4; ++m) f.load(MemberId(m), -1000);
  return f;
}

struct Parts {
  explicit Parts(const Building& building)
      : parts(building),
        shells(building),
        loads(building, part_loads(building, CombinationId(0u)), parts.bearings, shells),
        statics(building, shells, 1),
        components(building, statics),
        joints(building, 1),
        node_solved(building.nodes.size(), 1),
        response({parts, shells, loads, statics, joints, components, node_solved}),
        contacts(response, loads) {
    (void)loads.extract_changed();  // all of them, at first
    for (int c = 0; c < statics.components(); ++c) REQUIRE_FALSE(statics.solve(c));
  }
  StandingParts parts;
  PanelSuperelements shells;
  FrameLoads loads;
  FrameStatics statics;
  ComponentParts components;
  JointStates joints;
  std::vector<char> node_solved;
  FrameResponse response;
  ContactLoads contacts;
};

}  // namespace

TEST_CASE("what stands: segments are numbered by their least node, and what breaks off stands no more") {
  const FrameBuilder f = cantilevers(6);
  StandingParts parts(f.building);
  CHECK(parts.segment_count() == 2);
  CHECK(parts.segment(MemberId(0u)) == 0);
  CHECK(parts.segment(MemberId(3u)) == 1);
  CHECK(parts.one_segment({MemberId(0u), MemberId(1u)}));
  CHECK_FALSE(parts.one_segment({MemberId(0u), MemberId(2u)}));
  CHECK(parts.position(JointId(1u)) == Vec3(3, 0, 3));
  REQUIRE(parts.standing(JointId(0u)));
  parts.segments.break_joint(JointId(0u));
  parts.forget_numbers();
  CHECK_FALSE(parts.holds(JointId(0u)));
  const auto left = parts.segments.extract_unanchored();
  REQUIRE(left.size() == 1);
  CHECK(left[0].members == std::vector<MemberId>{MemberId(0u), MemberId(1u)});
  CHECK_FALSE(parts.stands(MemberId(1u)));
  CHECK_FALSE(parts.standing(JointId(1u)));  // it holds still, in what left
  CHECK(parts.holds(JointId(1u)));
  CHECK(parts.segment_count() == 1);
  CHECK(parts.segment(MemberId(3u)) == 0);
  CHECK(parts.one_segment({MemberId(0u), MemberId(2u)}));
}

TEST_CASE("components: what an analysis serves, and which joints of it can break") {
  const FrameBuilder f = cantilevers(6);
  const Parts all(f.building);
  REQUIRE(all.components.joints.size() == 2);
  CHECK(all.components.of(JointId(5u)) == all.statics.component(MemberId(2u)));
  CHECK(all.components.joints[static_cast<std::size_t>(all.components.of(JointId(0u)))] ==
        std::vector<JointId>{JointId(0u), JointId(1u)});
  CHECK(all.components.of(ContactPlace{MemberId(3u), {}, Vec3(6, 4, 3)}) == all.components.of(JointId(4u)));
}

TEST_CASE("numbers: each component has a frame of its own, with its parts numbered within it") {
  const FrameBuilder f = cantilevers(6);
  std::vector<topple::solver::FrameModel> models;
  const FrameNumbers numbers(f.building, make_frame(f.building), models);
  REQUIRE(numbers.components() == 2);
  REQUIRE(models.size() == 2);
  CHECK(numbers.nodes(1) == std::vector<NodeId>{NodeId(3u), NodeId(4u), NodeId(5u)});
  CHECK(numbers.members(1) == std::vector<MemberId>{MemberId(2u), MemberId(3u)});
  CHECK(numbers.plates(1).empty());
  CHECK(numbers.component(NodeId(5u)) == 1);
  CHECK(numbers.number(NodeId(5u)) == 2);
  CHECK(numbers.number(MemberId(3u)) == 1);
  CHECK(models[1].nodes[2] == f.building[NodeId(5u)].position);
  CHECK(models[1].beams[1].node == std::array{1, 2});
  REQUIRE(models[1].supports.size() == 1);
  CHECK(models[1].supports[0].node == 0);
}

TEST_CASE("a response needs no frame around it: a cantilever's tip, and its neighbour that feels nothing") {
  const double length = 6;
  const FrameBuilder f = cantilevers(length);
  const Parts all(f.building);
  const std::vector<ContactPlace> places{{MemberId(1u), {}, Vec3(length, 0, 3)},
                                         {MemberId(3u), {}, Vec3(length, 4, 3)}};
  const std::vector<Vec3> down(2, Vec3(0, 0, -1));
  const auto answer = all.response.respond(places, down);
  const double tip = length * length * length / (3 * E * Iy);
  constexpr double rounding = 1e-9;  // relative, of a solve of 24 equations
  CHECK(answer.compliance(0, 0) == Approx(tip).epsilon(rounding));
  CHECK(answer.compliance(1, 1) == Approx(tip).epsilon(rounding));
  CHECK(answer.compliance(0, 1) == 0);
  REQUIRE(answer.places[0].demands.size() == 2);
  CHECK(std::abs(answer.places[0].demands[0].second(4)) == Approx(length).epsilon(rounding));      // at the root
  CHECK(std::abs(answer.places[0].demands[1].second(4)) == Approx(length / 2).epsilon(rounding));  // in the middle
  // Of a uniform cantilever 33/140 of the mass goes along; here the member at the root counts by a straight line.
  CHECK(answer.places[0].rayleigh_mass == Approx(33.0 / 140 * 1000 * length / 10).epsilon(0.05));
  const auto near = all.response.respond_near(places, down);
  CHECK(near.compliance(0, 0) == Approx(tip).epsilon(rounding));
  CHECK(near.places[0].rayleigh_mass <= answer.places[0].rayleigh_mass);
}

TEST_CASE("contact loads act while they are there, and leave with what they lie on") {
  const double length = 6;
  const FrameBuilder f = cantilevers(length);
  Parts all(f.building);
  const ContactLoad weight{7, {MemberId(1u), {}, Vec3(length, 0, 3)}, Vec3(0, 0, -500), Vec3::Zero()};
  CHECK(all.contacts.set(weight));
  CHECK_FALSE(all.contacts.set(weight));  // it is there already
  CHECK(all.loads.changed());
  CHECK(all.loads.extract_changed().members == std::vector<MemberId>{MemberId(1u)});
  CHECK(all.loads.on(MemberId(1u)).size() == 2);  // its own, and the weight
  all.contacts.drop(MemberId(3u));
  CHECK(all.contacts.all().size() == 1);
  all.contacts.drop(MemberId(1u));
  CHECK(all.contacts.all().empty());
  CHECK(all.loads.on(MemberId(1u)).size() == 1);
  CHECK_FALSE(all.contacts.remove(7));
}

TEST_CASE("the way to rest needs no frame around it: a fixed beam sheds what its ends cannot hold") {
  const double length = 6, moment = 1e5, force = 1.3 * 8 * moment / length;
  JointCapacity end = same_capacity(1e12);
  end.value[5] = moment;
  end.ductility[5] = 0.1;
  FrameBuilder f;
  const NodeId a = f.node("A", 0, 0, 3), middle = f.node("M", length / 2, 0, 3), b = f.node("B", length, 0, 3);
  const MemberId left = f.member("AM", MemberKind::beam, a, middle, end),
                 right = f.member("MB", MemberKind::beam, middle, b, {}, end);
  f.support(a);
  f.support(b);
  f.load_case();
  Parts all(f.building);
  const std::vector<std::vector<topple::solver::BeamLoad>> applied(2);
  EnergyAccount account(
      {f.building, all.parts.segments, all.parts.bearings, all.loads, all.statics, all.node_solved, applied});
  account.start();
  const int generation = 3, c = all.statics.component(left);
  const auto solve = [&] {
    REQUIRE_FALSE(all.statics.solve(c));
    all.joints.set_demand(f.building.joint(left, 0), member_joint_demand(all.statics.end_forces(left), 0));
    all.joints.set_demand(f.building.joint(right, 1), member_joint_demand(all.statics.end_forces(right), 1));
  };
  YieldingWay way({all.parts, all.components, all.loads, applied, all.node_solved, all.statics, all.joints, account, 1,
                   generation, solve});
  REQUIRE(way.any(c));
  way.rest(c);
  account.write(middle, Vec6::Zero());
  all.statics.set_load(middle, (Vec6() << 0, 0, -force, 0, 0, 0).finished());
  solve();
  const double elastic = std::abs(all.statics.end_forces(left)(4));
  CHECK(elastic == Approx(force * length / 8).epsilon(1e-9));  // above what the ends hold
  std::vector<JointId> breaking;
  CHECK(way.follow(c, breaking) == YieldingWay::End::resting);
  CHECK(breaking.empty());
  // The ends hold their moment, the middle has what balance leaves: F L/4 - Mp.
  CHECK(std::abs(all.statics.end_forces(left)(4)) == Approx(moment).epsilon(1e-9));
  CHECK(std::abs(all.statics.end_forces(right)(10)) == Approx(moment).epsilon(1e-9));
  CHECK(std::abs(all.statics.end_forces(left)(10)) == Approx(force * length / 4 - moment).epsilon(1e-9));
  const std::vector<JointBreak> yielded = way.extract_yielded();
  REQUIRE(yielded.size() == 2);
  CHECK(yielded[0].generation == generation);
  CHECK(yielded[0].capacity == moment);
  CHECK(way.extract_yielded().empty());
  // What the hinges took is their moment times their turn: of each end F L2/16 EI less Mp L/2 EI.
  std::vector<JointBreak> none;
  account.finish(c, false, none);
  const double turn = force * length * length / (16 * E * Iy) - moment * length / (2 * E * Iy);
  CHECK(account.energy().dissipated == Approx(2 * moment * turn).epsilon(1e-6));
}

TEST_CASE("energies need no frame around them: a sudden load frees Clapeyron's half, a break what was stored") {
  const double length = 6, force = 1e4, stored = force * force * length * length * length / (6 * E * Iy);
  constexpr double rounding = 1e-9;  // relative, of a solve of 12 equations
  FrameBuilder f;
  const NodeId root = f.node("R", 0, 0, 3), middle = f.node("M", length / 2, 0, 3), tip = f.node("T", length, 0, 3);
  f.member("RM", MemberKind::beam, root, middle);
  const MemberId outer = f.member("MT", MemberKind::beam, middle, tip);
  f.support(root);
  f.load_case();
  Parts all(f.building);
  const std::vector<std::vector<topple::solver::BeamLoad>> applied(2);
  const SolvedFrame now{f.building, all.parts.segments, all.parts.bearings, all.loads, all.statics, all.node_solved,
                        applied};
  const int c = all.statics.component(outer);
  StateOfRest rest(now);
  rest.record(c);
  CHECK(rest.elastic(c, {}) == 0);
  std::vector<JointBreak> lines;

  ChangeFromRest loaded(now, rest);
  loaded.write(tip, Vec6::Zero());
  const Vec6 load = (Vec6() << 0, 0, -force, 0, 0, 0).finished();
  all.loads.add_load(tip, load);
  all.statics.set_load(tip, load);
  REQUIRE_FALSE(all.statics.solve(c));
  CHECK(loaded.finish(c, false, lines).freed == Approx(stored).epsilon(rounding));  // F u less 1/2 F u
  loaded.commit_to(rest);
  rest.record(c);
  CHECK(rest.elastic(c, {}) == Approx(stored).epsilon(rounding));
  CHECK(rest.load_work(c).other == Approx(2 * stored).epsilon(rounding));
  CHECK(rest.displacement(tip)(2) == Approx(-2 * stored / force).epsilon(rounding));

  // The outer half leaves with the load; the inner half springs back.
  ChangeFromRest broken(now, rest);
  const JointId joint = f.building.joint(outer, 0);
  broken.lose_joint(joint, -1);
  all.parts.segments.break_joint(joint);
  REQUIRE(all.parts.segments.extract_unanchored().size() == 1);
  broken.leave(outer);
  broken.leave(tip);
  all.statics.remove(outer);
  all.statics.drop({tip});
  all.node_solved[static_cast<std::size_t>(tip.index)] = 0;
  REQUIRE_FALSE(all.statics.solve(c));
  const ChangeFromRest::Sums sums = broken.finish(c, false, lines);
  CHECK(sums.freed == Approx(stored).epsilon(rounding));
  CHECK(sums.left.other == Approx(2 * stored).epsilon(rounding));  // the work that the load has done stays done
  broken.commit_to(rest);
  rest.record(c);
  // Nothing but rounding of what was there.
  CHECK(std::abs(rest.elastic(c, {})) < rounding * stored);
}

TEST_CASE("damping needs no motion: that of the material at the lowest frequency, found anew once breaks have ceased") {
  constexpr double rounding = 1e-9;  // relative, of an iteration for one mode
  FrameBuilder f = cantilevers(6);
  Material concrete = f.building.materials[0];
  concrete.youngs_modulus = 30e9;
  f.building.materials.push_back(concrete);
  f.building.members[2].material = f.building.members[3].material = MaterialId(1u);
  Parts all(f.building);
  const std::vector<std::vector<topple::solver::BeamLoad>> applied(4);
  EnergyAccount account(
      {f.building, all.parts.segments, all.parts.bearings, all.loads, all.statics, all.node_solved, applied});
  for (const NodeId tip : {NodeId(2u), NodeId(5u)}) {
    all.statics.set_load(tip, (Vec6() << 0, 0, -1e4, 0, 0, 0).finished());
    REQUIRE_FALSE(all.statics.solve(all.statics.component(tip)));
  }
  const int generation = 0, steel = all.components.of(JointId(0u)), other = 1 - steel;
  YieldingWay way({all.parts, all.components, all.loads, applied, all.node_solved, all.statics, all.joints, account, 1,
                   generation, [] {}});
  const MotionSources sources{f.building,     all.parts,  all.loads, all.statics,     all.joints, way,
                              all.components, all.shells, account,   all.node_solved, false,      1};
  const MotionMasses masses(f.building, all.loads, all.parts.bearings);
  const MotionModel model(sources, masses);
  MotionSettings settings;
  settings.metal_damping = 0.03;
  settings.other_damping = 0.07;
  ComponentDamping damping(sources, model, settings);
  for (const int c : {steel, other}) {
    const auto found = damping.start(c, model.frame(c), model.node_masses(c), model.at_rest(c));
    const double frequency = damping.first_frequency(c);
    CHECK(found.mass / (2 * frequency) + found.stiffness * frequency / 2 ==
          Approx(c == steel ? 0.03 : 0.07).epsilon(rounding));
    CHECK(damping.update(c) == nullptr);
  }
  // The same beams of another modulus.
  CHECK(damping.first_frequency(steel) / damping.first_frequency(other) ==
        Approx(std::sqrt(200.0 / 30)).epsilon(rounding));

  all.parts.segments.break_joint(f.building.joint(MemberId(0u), 1));
  CHECK(damping.update(steel) == nullptr);  // more may break
  CHECK(damping.update(other) == nullptr);
  CHECK(damping.update(steel) == &damping.of(steel));
  CHECK(damping.update(steel) == nullptr);
}
