// Joints that turn before they break, against the closed forms of plastic analysis.
#include <catch2/catch.hpp>

#include "structure/frame_builder.h"
#include "topple/structure/standing_frame.h"

namespace {

using namespace topple::test;

constexpr double rounding = 1e-7;  // relative; closed forms, a few solves one after the other, condition below 1e7
constexpr double EI = 200e9 * 2e-4, E_Iz = 200e9 * 1e-4, GJ = 80e9 * 1.5e-4;  // of FrameBuilder's bar

/// Holds `moment` about both axes while it turns by `rotation`; all else is strong.
JointCapacity ductile(double moment, double rotation) {
  JointCapacity capacity = same_capacity(1e12);
  capacity.value[5] = capacity.value[6] = moment;
  capacity.ductility[5] = capacity.ductility[6] = rotation;
  return capacity;
}

FailureRules quiet(double sudden = 1) {
  FailureRules rules;
  rules.bracing = BracingRule::none;
  rules.sudden = sudden;
  return rules;
}

Vec6 down(double force) { return (Vec6() << 0, 0, -force, 0, 0, 0).finished(); }

/// Elastic energy gained is work done less what was freed and dissipated: each measured on its own.
void check_energy(const StandingFrame& standing) {
  const FrameEnergy e = standing.energy();
  const double gained = e.elastic - e.elastic_at_start;
  const double put_in = e.gravity_work + e.other_work + e.contact_work - e.freed - e.dissipated;
  CHECK(gained == Approx(put_in).margin(1e-7 * (std::abs(gained) + e.dissipated + std::abs(e.freed))));
}

/// Built in at both ends, jointed in the middle, ductile at all four ends of its two halves.
struct FixedBeam {
  explicit FixedBeam(double moment, double rotation = 0.1) {
    frame.load_case();
    const NodeId a = frame.node("A", 0, 0, 3);
    middle = frame.node("M", length / 2, 0, 3);
    const NodeId b = frame.node("B", length, 0, 3);
    left = frame.member("AM", MemberKind::beam, a, middle, ductile(moment, rotation), ductile(moment, rotation));
    right = frame.member("MB", MemberKind::beam, middle, b, ductile(moment, rotation), ductile(moment, rotation));
    frame.support(a);
    frame.support(b);
  }
  static constexpr double length = 6;
  FrameBuilder frame;
  NodeId middle;
  MemberId left, right;
};

/// A cantilever whose root is ductile, about y or (turned) in torsion.
struct Cantilever {
  explicit Cantilever(const JointCapacity& root) {
    frame.load_case();
    const NodeId a = frame.node("A", 0, 0, 3);
    tip = frame.node("B", length, 0, 3);
    beam = frame.member("AB", MemberKind::beam, a, tip, root);
    frame.support(a);
  }
  static constexpr double length = 3;
  FrameBuilder frame;
  NodeId tip;
  MemberId beam;
};

}  // namespace

TEST_CASE("a fixed beam under a central load collapses at 8 Mp/L") {
  const double moment = 1e5, collapse = 8 * moment / FixedBeam::length;
  for (const double share : {0.999, 1.001}) {
    const FixedBeam beam(moment);
    StandingFrame standing(beam.frame.building, CombinationId(0u), quiet());
    standing.add_load(beam.middle, down(share * collapse));
    const auto breaks = standing.settle(20);
    CHECK(standing.stands(beam.left) == (share < 1));
    CHECK(breaks.empty() == (share < 1));
    if (share > 1) CHECK(standing.extract_yielded().size() >= 3);
  }
}

TEST_CASE("a fixed beam under uniform load yields at its ends at 12 Mp/L2, in the middle at 16 Mp/L2") {
  const double moment = 1e5, L = FixedBeam::length, first = 12 * moment / (L * L), collapse = 16 * moment / (L * L);
  for (const double q : {0.999 * first, 0.9 * collapse, 1.001 * collapse}) {
    FixedBeam beam(moment);
    beam.frame.load(beam.left, -q);
    beam.frame.load(beam.right, -q);
    StandingFrame standing(beam.frame.building, CombinationId(0u), quiet());
    // At the start the elastic state is over the capacity: the excess is shed in the first generation.
    const auto breaks = standing.settle(20);
    const auto yielded = standing.extract_yielded();
    CHECK(standing.stands(beam.left) == (q < collapse));
    if (q < first) CHECK(yielded.empty());
    if (q < first || q > collapse) continue;
    CHECK(breaks.empty());
    REQUIRE(yielded.size() == 2);
    CHECK(yielded[0].joint == beam.frame.building.joint(beam.left, 0));
    CHECK(yielded[1].joint == beam.frame.building.joint(beam.right, 1));
    CHECK(yielded[0].sense == Sense::moment_y);
    CHECK(yielded[0].capacity == Approx(moment));
    CHECK(std::abs(standing.demand(yielded[0].joint)(4)) == Approx(moment).epsilon(rounding));
    const JointId inner = beam.frame.building.joint(beam.left, 1);
    CHECK(std::abs(standing.demand(inner)(4)) == Approx(q * L * L / 8 - moment).epsilon(rounding));
    const double sag = 5 * q * std::pow(L, 4) / (384 * EI) - moment * L * L / (8 * EI);
    CHECK(-standing.displacement(beam.middle)(2) == Approx(sag).epsilon(rounding));
    CHECK(standing.utilisation(yielded[0].joint).value == Approx(1));
    check_energy(standing);
    // End rotation of the simply supported beam less what the end moments turn back.
    const double turn = q * L * L * L / (24 * EI) - moment * L / (2 * EI);
    CHECK(standing.energy().dissipated == Approx(2 * moment * turn).epsilon(rounding));
    const auto both_ends_turned = [&] {
      const auto turned = standing.plastic_rotations();
      REQUIRE(turned.size() == 2);
      for (std::size_t end = 0; end < 2; ++end) {
        CHECK(turned[end].joint == yielded[end].joint);
        CHECK(turned[end].sense == Sense::moment_y);
        CHECK(std::abs(turned[end].turned) == Approx(turn).epsilon(rounding));
        CHECK(turned[end].limit == 0.1);
      }
      CHECK(turned[0].turned * turned[1].turned < 0);  // the beam is symmetric
    };
    both_ends_turned();
    // Unloading is elastic: with the load gone the ends keep their angle, and with it a residual moment.
    standing.set_gravity(Vec3::Zero());
    CHECK(standing.settle(20).empty());
    const double residual = q * L * L / 12 - moment;  // of the opposite sense, all along
    CHECK(std::abs(standing.demand(yielded[0].joint)(4)) == Approx(residual).epsilon(rounding));
    CHECK(std::abs(standing.demand(inner)(4)) == Approx(residual).epsilon(rounding));
    CHECK(-standing.displacement(beam.middle)(2) == Approx(sag - q * std::pow(L, 4) / (384 * EI)).epsilon(rounding));
    CHECK(standing.extract_yielded().empty());
    both_ends_turned();
    check_energy(standing);
  }
}

TEST_CASE("a portal with built-in feet sways at 4 Mp/h") {
  const double moment = 8e4, height = 4, span = 6, collapse = 4 * moment / height;
  for (const double share : {0.99, 1.01}) {
    FrameBuilder frame;
    frame.load_case();
    const NodeId a0 = frame.node("A0", 0, 0, 0), a1 = frame.node("A1", 0, 0, height);
    const NodeId b1 = frame.node("B1", span, 0, height), b0 = frame.node("B0", span, 0, 0);
    const JointCapacity joint = ductile(moment, 0.1);
    frame.member("PA", MemberKind::post, a0, a1, joint, joint);
    const MemberId pb = frame.member("PB", MemberKind::post, b0, b1, joint, joint);
    frame.member("AB", MemberKind::beam, a1, b1, joint, joint);
    frame.support(a0);
    frame.support(b0);
    StandingFrame standing(frame.building, CombinationId(0u), quiet());
    standing.add_load(a1, (Vec6() << share * collapse, 0, 0, 0, 0, 0).finished());
    const auto breaks = standing.settle(50);
    CHECK(breaks.empty() == (share < 1));
    if (share < 1) {
      CHECK(standing.stands(pb));
      CHECK(standing.extract_yielded().size() >= 2);
      check_energy(standing);
    }
  }
}

TEST_CASE("an elastic-plastic spring of ductility m bears 1 - 1/(2 m) of its yield force at once") {
  const double moment = 1e5, L = Cantilever::length, yield_force = moment / L;
  for (const double m : {1.5, 3.0, 8.0}) {
    const double elastic = yield_force * L * L * L / (3 * EI), rotation = (m - 1) * elastic / L;
    const double borne = (1 - 1 / (2 * m)) * yield_force;
    for (const double share : {0.999, 1.001}) {
      const Cantilever beam(ductile(moment, rotation));
      StandingFrame standing(beam.frame.building, CombinationId(0u), quiet(2));
      standing.add_load(beam.tip, down(share * borne));
      const auto breaks = standing.settle(20);
      CHECK(breaks.empty() == (share < 1));
      CHECK(standing.stands(beam.beam) == (share < 1));
      const auto yielded = standing.extract_yielded();
      REQUIRE(yielded.size() == 1);
      if (share > 1) {
        CHECK(breaks[0].sense == Sense::moment_y);
        CHECK(breaks[0].cause == BreakCause::overload);
        continue;
      }
      // The peak deflection u by energy: P u = Fy (u - uy/2); then back by (Fy - P)/k, and the angle stays.
      const double P = share * borne, peak = yield_force * elastic / 2 / (yield_force - P);
      CHECK(-standing.displacement(beam.tip)(2) ==
            Approx(peak - (yield_force - P) * L * L * L / (3 * EI)).epsilon(rounding));
      CHECK(standing.energy().dissipated == Approx(yield_force * (peak - elastic)).epsilon(rounding));
      check_energy(standing);
    }
  }
}

TEST_CASE("below half of its yield force an elastic-plastic spring stays elastic under a sudden load") {
  const double moment = 1e5, L = Cantilever::length;
  const Cantilever beam(ductile(moment, 0.01));
  StandingFrame standing(beam.frame.building, CombinationId(0u), quiet(2));
  standing.add_load(beam.tip, down(0.499 * moment / L));
  CHECK(standing.settle(20).empty());
  CHECK(standing.extract_yielded().empty());
  CHECK(standing.energy().dissipated == 0);
  CHECK(standing.largest_utilisation_so_far(beam.frame.building.joint(beam.beam, 0)) == Approx(0.998));
}

TEST_CASE("a joint that yields in torsion twists on under its torque and breaks at its limit") {
  const double torque = 5e4, L = Cantilever::length, rotation = 0.02;
  for (const bool far : {false, true}) {
    FrameBuilder frame;
    frame.load_case();
    const NodeId a = frame.node("A", 0, 0, 3), m = frame.node("M", L, 0, 3), b = frame.node("B", 2 * L, 0, 3);
    JointCapacity root = same_capacity(1e12);
    root.value[4] = torque;
    root.ductility[4] = rotation;
    const MemberId left = frame.member("AM", MemberKind::beam, a, m, root);
    frame.member("MB", MemberKind::beam, m, b);
    frame.support(a);
    frame.support(b);
    StandingFrame standing(frame.building, CombinationId(0u), quiet());
    // Elastically each half takes half of it; beyond 2 Tp the other half takes what is added.
    const double limit_torque = 2 * torque + GJ / L * rotation;
    const double applied = far ? 1.001 * limit_torque : 2 * torque + 0.5 * GJ / L * rotation;
    standing.add_load(m, (Vec6() << 0, 0, 0, applied, 0, 0).finished());
    const auto breaks = standing.settle(20);
    REQUIRE(standing.extract_yielded().size() == 1);
    CHECK(standing.displacement(m)(3) == Approx((applied - (far ? 0 : torque)) * L / GJ).epsilon(rounding));
    CHECK(breaks.size() == (far ? 1u : 0u));
    CHECK(standing.stands(left));
    CHECK(standing.energy().dissipated == Approx(torque * (far ? rotation : 0.5 * rotation)).epsilon(rounding));
    check_energy(standing);
  }
}

TEST_CASE("a joint that is weakened below what it bears yields, and its neighbours take the rest") {
  const double q = 1e4, L = FixedBeam::length, end = q * L * L / 12;
  FixedBeam beam(1.3 * end);
  beam.frame.load(beam.left, -q);
  beam.frame.load(beam.right, -q);
  StandingFrame standing(beam.frame.building, CombinationId(0u), quiet());
  const JointId root = beam.frame.building.joint(beam.left, 0);
  standing.set_strength_factor(root, 0.5);
  CHECK(standing.settle(20).empty());
  CHECK(std::abs(standing.demand(root)(4)) == Approx(0.65 * end).epsilon(rounding));
  CHECK(std::abs(standing.demand(beam.frame.building.joint(beam.right, 1))(4)) ==
        Approx(1.175 * end).epsilon(rounding));
  CHECK(standing.extract_yielded().size() == 1);
  check_energy(standing);
}
