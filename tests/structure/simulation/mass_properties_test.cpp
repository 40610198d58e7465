// Mass, centre and inertia against closed forms, and against sums over many small pieces.
#include "simulation/debris/mass_properties.h"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <vector>

#include "frame_builder.h"
#include "simulation/accounts/replay_hash.h"
#include "simulation/step_clock.h"

using namespace topple::structure;
using topple::test::FrameBuilder;

namespace {

/// By brute force: a solid box cut into small cubes.
MassProperties cubes(const Vec3& centre, const Vec3& size, const Mat3& axes, double mass, int n) {
  MassProperties sum;
  const double share = mass / (n * n * n);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (int k = 0; k < n; ++k) {
        const Vec3 local(size.x() * ((i + 0.5) / n - 0.5), size.y() * ((j + 0.5) / n - 0.5),
                         size.z() * ((k + 0.5) / n - 0.5));
        sum.add(point_mass(centre + axes.transpose() * local, share));
      }
  return sum;
}

topple::solver::BeamLoad spread(const Member& member, double from, double to, double first, double last) {
  topple::solver::BeamLoad load;
  load.from = from;
  load.to = to;
  load.first.head<3>() = member.axes * Vec3(0, 0, -first);
  load.last.head<3>() = member.axes * Vec3(0, 0, -last);
  return load;
}

}  // namespace

TEST_CASE("a member's inertia is that of a solid box of its section") {
  FrameBuilder f;
  f.building.sections[0].depth = 0.3;
  f.building.sections[0].width = 0.2;
  f.building.sections[0].area = 0.06;
  f.building.sections[0].Iy = 0.2 * 0.3 * 0.3 * 0.3 / 12;
  f.building.sections[0].Iz = 0.3 * 0.2 * 0.2 * 0.2 / 12;
  const MemberId id = f.member("AB", MemberKind::beam, f.node("A", 1, 2, 3), f.node("B", 3, 5, 4));
  const Member& member = f.building[id];
  const double per_length = 600, g = 10;
  const auto line = line_mass(member, {spread(member, 0, member.length, per_length * g, per_length * g)}, g);
  CHECK(line.mass == Approx(per_length * member.length).epsilon(1e-13));
  const MassProperties got = member_mass(f.building, member, line);
  const MassProperties box =
      cubes(Vec3(2, 3.5, 3.5), Vec3(member.length, 0.2, 0.3), member.axes, per_length * member.length, 30);
  CHECK((got.centre - box.centre).norm() < 1e-12);
  CHECK((got.inertia - box.inertia).norm() < 2e-3 * box.inertia.norm());  // n cubes miss 1 / n^2 of an inertia
}

TEST_CASE("a trapezoidal and a point load put the mass where they act") {
  FrameBuilder f;
  const MemberId id = f.member("AB", MemberKind::beam, f.node("A", 0, 0, 0), f.node("B", 8, 0, 0));
  const Member& member = f.building[id];
  auto point = spread(member, 6, 6, 50, 0);
  point.kind = topple::solver::BeamLoad::Kind::point;
  const auto line = line_mass(member, {spread(member, 1, 4, 20, 80), point}, 10);
  double mass = 5, first = 5 * 6, second = 5 * 36;  // midpoint sums over the trapezoid, error 1 / n^2
  const int n = 20000;
  for (int i = 0; i < n; ++i) {
    const double t = (i + 0.5) / n, m = (2 + 6 * t) * 3 / n, x = 1 + 3 * t;
    mass += m;
    first += m * x;
    second += m * x * x;
  }
  CHECK(line.mass == Approx(mass).epsilon(1e-8));
  CHECK(line.first_moment == Approx(first).epsilon(1e-8));
  CHECK(line.second_moment == Approx(second).epsilon(1e-8));
}

TEST_CASE("a plate with an opening weighs and turns like the plate less the piece cut out") {
  FrameBuilder f;
  const NodeId a = f.node("A", 0, 0, 3), b = f.node("B", 6, 0, 3), c = f.node("C", 6, 4, 3), d = f.node("D", 0, 4, 3);
  const PanelId id = f.panel("S", PanelModel::membrane, {a, b, c, d});
  Panel& panel = f.building.panels[static_cast<std::size_t>(id.index)];
  panel.thickness = 0.2;
  panel.openings = {{{1, 1}, {3, 1}, {3, 2}, {1, 2}}};
  const double per_area = 500;
  const MassProperties got = panel_mass(f.building, panel, per_area * (24 - 2));
  MassProperties rest = cubes(Vec3(2, 1.5, 3), Vec3(2, 1, 0.2), Mat3::Identity(), per_area * 2, 40);
  rest.add(got);
  const Mat3 whole = per_area * 24 / 12 * Vec3(16 + 0.04, 36 + 0.04, 36 + 16).asDiagonal().toDenseMatrix();
  CHECK((rest.centre - Vec3(3, 2, 3)).norm() < 1e-12);
  CHECK((rest.inertia - whole).norm() < 1e-4 * whole.norm());  // the cut piece is summed over cubes
}

TEST_CASE("an event belongs to the first step that ends at or after it") {
  CHECK(step_of(0, 1.0 / 60) == 1);
  CHECK(step_of(1, 1.0 / 60) == 60);
  CHECK(step_of(1.0 + 1e-9, 1.0 / 60) == 60);  // within 1e-6 of a step
  CHECK(step_of(1.0 + 1e-7, 1.0 / 60) == 61);
  for (int k = 1; k < 5000; ++k) CHECK(step_of(k * 0.1, 0.1) == k);
}

TEST_CASE("the replay hash is FNV-1a of the bytes") {
  ReplayHash hash;
  hash.add(std::string_view("a"));
  ReplayHash other;
  other.add(std::string_view("b"));
  CHECK(hash.value() != other.value());
  ReplayHash zero, minus_zero;
  zero.add(0.0);
  minus_zero.add(-0.0);
  CHECK(zero.value() != minus_zero.value());             // raw bits
  CHECK(ReplayHash().value() == 0xcbf29ce484222325ull);  // the published offset basis
}
