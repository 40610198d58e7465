// Second order and buckling against closed forms and the AISC benchmarks, one member for each column.
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>

#include "topple/solver/buckling.h"
#include "topple/solver/second_order.h"

using namespace topple::solver;

namespace {

constexpr double pi = 3.14159265358979323846;

/// A vertical column of one member with different inertias, local z along global x: bending in the x-z plane is by Iy.
struct Column {
  FrameModel model;
  explicit Column(double length, const Vec6& foot, const Vec6& head) {
    model.nodes = {Vec3(0, 0, 0), Vec3(0, 0, length)};
    Beam beam;
    beam.node = {0, 1};
    beam.axes << 0, 0, 1, 0, -1, 0, 1, 0, 0;
    beam.length = length;
    beam.youngs_modulus = 2e11;
    beam.shear_modulus = 8e10;
    beam.area = 0.01;
    beam.Iy = 1e-4;
    beam.Iz = 3e-5;
    beam.J = 1e-6;
    model.beams = {beam};
    model.supports = {{0, foot}, {1, head}};
  }
  Beam& beam() { return model.beams.front(); }
};

Vec6 held(std::initializer_list<int> components) {
  Vec6 k = Vec6::Zero();
  for (int c : components) k(c) = rigid;
  return k;
}
const Vec6 fixed = Vec6::Constant(rigid);

LoadSet at_head(double x, double y, double z) {
  LoadSet loads;
  NodeLoad load{1, Vec6::Zero()};
  load.load.head<3>() << x, y, z;
  loads.nodes.push_back(load);
  return loads;
}

SecondOrderSolution solve(const FrameModel& model, const LoadSet& loads, SecondOrder mode = SecondOrder::exact) {
  const StaticSolution linear = StaticAnalysis(model).solve({&loads, 1}).front();
  return SecondOrderAnalysis(model, mode).solve(loads, linear);
}

SecondOrderDiagram diagram(const FrameModel& model, const SecondOrderSolution& found) {
  const Beam& beam = model.beams.front();
  return {beam, found.axial, 0, found.solution.beam_end_forces[0],
          beam_rigid_end_displacements(beam, found.solution.displacements)};
}

double lowest(const FrameModel& model, const LoadSet& loads) {
  const auto modes = buckling_modes(model, loads, 1, {});
  REQUIRE(modes.size() == 1);
  return modes[0].factor;
}

}  // namespace

TEST_CASE("one exact member is a beam-column: sway and base moment of a cantilever, both ways, pushed or pulled") {
  const double L = 6, H = 1000;
  for (const bool weak : {false, true})
    for (const double share : {0.05, 0.6, 0.95, -0.5, -20.0, -400.0}) {
      Column column(L, fixed, Vec6::Zero());
      const double EI = 2e11 * (weak ? 3e-5 : 1e-4), P = share * pi * pi * 2e11 * 3e-5 / (4 * L * L);
      const SecondOrderSolution found = solve(column.model, at_head(weak ? 0 : H, weak ? H : 0, -P));
      const double a = L * std::sqrt(std::abs(P) / EI);
      const double tip = P > 0 ? H * L * L * L / EI * (std::tan(a) - a) / (a * a * a)
                               : H * L * L * L / EI * (a - std::tanh(a)) / (a * a * a);
      const double base = H * L * (P > 0 ? std::tan(a) : std::tanh(a)) / a;
      INFO("P " << P << " weak " << weak);
      // Near the critical load the answer is as sensitive as 1/(1 - P/Pcr): five digits of sixteen.
      CHECK(found.solution.displacements[1](weak ? 1 : 0) == Approx(tip).epsilon(1e-9));
      CHECK(std::abs(found.solution.reactions[0](weak ? 3 : 4)) == Approx(base).epsilon(1e-9));
      CHECK(found.solution.reactions[0].head<3>().isApprox(Vec3(weak ? 0 : -H, weak ? -H : 0, P), 1e-9));
    }
}

TEST_CASE("AISC's benchmark beam-columns, with and without shear, by one exact member") {
  // W14x48, 28 ft, strong axis; kip and inches. AISC 360-10 commentary, Fig. C-C2.2 and C-C2.3.
  const double L = 336, w = 0.2 / 12;
  struct Case {
    double P, moment, deflection, moment_rigid, deflection_rigid;
  };
  const auto make = [&](Column& column, bool shear) {
    Beam& beam = column.beam();
    beam.youngs_modulus = 29000;
    beam.shear_modulus = 29000 / 2.6;
    beam.area = 14.1;
    beam.Iy = 484;
    beam.Iz = 484;
    beam.shear_area_z = shear ? 13.8 * 0.340 : 0;
  };
  for (const Case& c : {Case{0, 235, 0.202, 235, 0.197}, Case{150, 270, 0.230, 269, 0.224},
                        Case{300, 316, 0.269, 313, 0.261}, Case{450, 380, 0.322, 375, 0.311}}) {
    for (const bool shear : {true, false}) {
      Column column(L, held({0, 1, 2, 5}), held({0, 1}));
      make(column, shear);
      LoadSet loads = at_head(0, 0, -c.P);
      BeamLoad load;
      load.beam = 0;
      load.to = L;
      load.first(2) = load.last(2) = w;
      loads.beams.push_back(load);
      const SecondOrderSolution found = solve(column.model, loads);
      const auto d = diagram(column.model, found);
      const double moment = std::abs(d.values(L / 2)[BeamDiagram::moment_y]);
      const double deflection = std::abs(d.values(L / 2)[BeamDiagram::deflection_z]);
      INFO("P " << c.P << " shear " << shear);
      CHECK(moment == Approx(shear ? c.moment : c.moment_rigid).epsilon(0.003));
      // Three printed digits, and 0.3 % between the published figures and the closed forms.
      CHECK(deflection == Approx(shear ? c.deflection : c.deflection_rigid).epsilon(0.004));
      const auto range = d.extremes(BeamDiagram::moment_y);
      CHECK(std::max(std::abs(range.least.value), std::abs(range.greatest.value)) == Approx(moment).epsilon(1e-9));
    }
  }
  for (const Case& c : {Case{0, 336, 0.907, 336, 0.901}, Case{100, 470, 1.34, 469, 1.33},
                        Case{150, 601, 1.77, 598.65, 1.75}, Case{200, 856, 2.60, 848.98, 2.56}}) {
    for (const bool shear : {true, false}) {
      Column column(L, fixed, Vec6::Zero());
      make(column, shear);
      const SecondOrderSolution found = solve(column.model, at_head(1, 0, -c.P));
      INFO("P " << c.P << " shear " << shear);
      CHECK(std::abs(found.solution.reactions[0](4)) == Approx(shear ? c.moment : c.moment_rigid).epsilon(0.003));
      CHECK(found.solution.displacements[1](0) == Approx(shear ? c.deflection : c.deflection_rigid).epsilon(0.004));
    }
  }
}

TEST_CASE(
    "the cubic geometric stiffness is within 1 % of the exact answer, and closes on it when members are divided") {
  const double L = 6, H = 1000, EI = 2e11 * 1e-4, P = 0.4 * pi * pi * 2e11 * 3e-5 / (4 * L * L);
  const double a = L * std::sqrt(P / EI), tip = H * L * L * L / EI * (std::tan(a) - a) / (a * a * a);
  double before = 0;
  for (int parts : {1, 2, 4}) {
    Column whole(L, fixed, Vec6::Zero());
    FrameModel model;
    for (int i = 0; i <= parts; ++i) model.nodes.push_back(Vec3(0, 0, L * i / parts));
    for (int i = 0; i < parts; ++i) {
      Beam beam = whole.beam();
      beam.node = {i, i + 1};
      beam.length = L / parts;
      model.beams.push_back(beam);
    }
    model.supports = {{0, fixed}};
    LoadSet loads = at_head(H, 0, -P);
    loads.nodes[0].node = parts;
    const auto top = static_cast<std::size_t>(parts);
    const double error = solve(model, loads, SecondOrder::cubic).solution.displacements[top](0) / tip - 1;
    CHECK(std::abs(error) < 0.01);
    if (parts > 1) CHECK(std::abs(before / error) > 12);  // fourth order: 16 in the limit
    before = error;
    CHECK(solve(model, loads, SecondOrder::exact).solution.displacements[top](0) == Approx(tip).epsilon(1e-10));
  }
}

TEST_CASE("without axial force second order is first order, springs, releases, loads and all") {
  Column column(6, fixed, held({0, 1}));
  column.beam().shear_area_y = 0.004;
  column.beam().shear_area_z = 0.006;
  column.beam().end_stiffness[0](4) = 3e6;
  column.beam().end_stiffness[0](5) = 0;
  column.beam().end_stiffness[1](1) = 5e6;
  LoadSet loads;
  BeamLoad load;
  load.beam = 0;
  load.from = 1;
  load.to = 4;
  load.first << 0, 1e3, 2e3, 0, 100, 50;
  load.last << 0, -4e2, 5e3, 0, 30, -70;
  BeamLoad point;
  point.beam = 0;
  point.kind = BeamLoad::Kind::point;
  point.from = 2.5;
  point.first << 0, 3e3, -1e3, 0, 400, 900;
  BeamLoad heat;
  heat.beam = 0;
  heat.kind = BeamLoad::Kind::temperature;
  heat.curvature_y = 1e-4;
  heat.curvature_z = -3e-4;
  loads.beams = {load, point, heat};
  const StaticSolution linear = StaticAnalysis(column.model).solve({&loads, 1}).front();
  for (const SecondOrder mode : {SecondOrder::exact, SecondOrder::cubic}) {
    const SecondOrderSolution found = solve(column.model, loads, mode);
    for (std::size_t n = 0; n < 2; ++n)
      CHECK((found.solution.displacements[n] - linear.displacements[n]).norm() < 1e-9 * linear.displacements[1].norm());
    CHECK((found.solution.beam_end_forces[0] - linear.beam_end_forces[0]).norm() <
          1e-9 * linear.beam_end_forces[0].norm());
    const BeamDiagram first(column.beam(), linear.beam_end_forces[0], loads.beams);
    const SecondOrderDiagram second = diagram(column.model, found);
    for (const double x : {0.0, 0.7, 2.5, 3.3, 5.0, 6.0}) {
      const auto expected = first.values(x), values = second.values(x);
      for (std::size_t q = 0; q < 8; ++q) {
        INFO("x " << x << " quantity " << q);
        CHECK(values[q] == Approx(expected[q]).epsilon(1e-8).margin(q < 6 ? 1e-5 : 1e-12));
      }
    }
  }
}

TEST_CASE("a point load at a member's end, or hardly off it, acts in second order as on the node there") {
  const double L = 6, H = 1000, M = 700, P = 0.6 * pi * pi * 2e11 * 3e-5 / (4 * L * L);
  for (const bool weak : {false, true}) {
    const Column column(L, fixed, Vec6::Zero());
    LoadSet on_node = at_head(weak ? 0 : H, weak ? H : 0, -P);
    on_node.nodes[0].load(weak ? 3 : 4) = M;
    const SecondOrderSolution expected = solve(column.model, on_node);
    // 6 (1 - 1e-16) is what is left of 6 m after a change of units; the last places are off the end by what they say.
    for (const double off : {0.0, 1e-16, 1e-13, 1e-9, 1e-7}) {
      LoadSet loads = at_head(0, 0, -P);
      BeamLoad point;
      point.beam = 0;
      point.kind = BeamLoad::Kind::point;
      point.from = L * (1 - off);
      point.first.head<3>() = column.model.beams[0].axes * on_node.nodes[0].load.head<3>().cwiseProduct(Vec3(1, 1, 0));
      point.first.tail<3>() = column.model.beams[0].axes * on_node.nodes[0].load.tail<3>();
      loads.beams = {point};
      point.from = L * off;  // at the foot it goes into the support
      loads.beams.push_back(point);
      const SecondOrderSolution found = solve(column.model, loads);
      INFO("off the end by " << off << " of the length, weak " << weak);
      const double near = 1e-9 + 20 * off;
      CHECK(found.solution.displacements[1].isApprox(expected.solution.displacements[1], near));
      Vec6 reaction = expected.solution.reactions[0];
      reaction.head<2>() -= on_node.nodes[0].load.head<2>();
      reaction.tail<3>() -= on_node.nodes[0].load.tail<3>();
      CHECK(found.solution.reactions[0].isApprox(reaction, near));
      CHECK(diagram(column.model, found).values(0.9 * L)[weak ? 5 : 4] ==
            Approx(diagram(column.model, expected).values(0.9 * L)[weak ? 5 : 4]).epsilon(near));
    }
  }
}

TEST_CASE("extremes in second order bound every value along the beam, near its loads too, and both sides of a jump") {
  const double L = 6, P = 0.5 * pi * pi * 2e11 * 3e-5 / (L * L);
  const Column column(L, held({0, 1, 2, 5}), held({0, 1}));
  for (int i = 1; i < 60; ++i) {
    LoadSet loads = at_head(0, 0, -P);
    BeamLoad point;
    point.beam = 0;
    point.kind = BeamLoad::Kind::point;
    point.from = L * i / 60;
    point.first << 0, 4e3, -3e3, 0, 2e3, 5e3;
    BeamLoad even;
    even.beam = 0;
    even.to = L;
    even.first << 0, 1e3, 2e3, 0, 0, 0;
    even.last = even.first;
    loads.beams = {point, even};
    const auto d = diagram(column.model, solve(column.model, loads));
    std::array<double, BeamDiagram::quantities> least{}, greatest{};
    for (int k = 0; k <= 600; ++k)
      // Off the place of the point load by hardly anything: the other side of what jumps there.
      for (const double x : {L * k / 600, std::min(L, L * k / 600 + 1e-9)}) {
        const auto values = d.values(x);
        for (std::size_t q = 0; q < values.size(); ++q) {
          least[q] = k == 0 ? values[q] : std::min(least[q], values[q]);
          greatest[q] = k == 0 ? values[q] : std::max(greatest[q], values[q]);
        }
      }
    for (std::size_t q = 0; q < least.size(); ++q) {
      const BeamDiagram::Range range = d.extremes(static_cast<BeamDiagram::Quantity>(q));
      const double rounding = 1e-7 * std::max(std::abs(range.least.value), std::abs(range.greatest.value));
      INFO("load at " << point.from << ", quantity " << q);
      CHECK(range.least.value <= least[q] + rounding);
      CHECK(range.greatest.value >= greatest[q] - rounding);
    }
  }
}

TEST_CASE("a load that begins or acts hardly off an end or another one leaves critical factors alone") {
  const double L = 5, P = 1000, euler = pi * pi * 2e11 * 3e-5 / (L * L) / P;
  for (const double off : {0.0, 1e-16, 1e-12, 1e-8, 1e-5}) {
    LoadSet loads = at_head(0, 0, -P);
    BeamLoad point;
    point.beam = 0;
    point.kind = BeamLoad::Kind::point;
    point.first(1) = 300;
    for (const double at : {L * off, 0.4 * L, 0.4 * L * (1 + off), L * (1 - off)}) {
      point.from = at;
      loads.beams.push_back(point);
    }
    INFO("off by " << off);
    CHECK(lowest(Column(L, held({0, 1, 2, 5}), held({0, 1})).model, loads) == Approx(euler).epsilon(1e-9));
  }
}

TEST_CASE("Euler's columns buckle at their closed forms with one member each") {
  const double L = 5, P = 1000;
  const double euler = pi * pi * 2e11 * 3e-5 / (L * L) / P;  // about the weak axis
  CHECK(lowest(Column(L, fixed, Vec6::Zero()).model, at_head(0, 0, -P)) == Approx(euler / 4).epsilon(1e-9));
  CHECK(lowest(Column(L, held({0, 1, 2, 5}), held({0, 1})).model, at_head(0, 0, -P)) == Approx(euler).epsilon(1e-9));
  CHECK(lowest(Column(L, fixed, held({0, 1})).model, at_head(0, 0, -P)) ==
        Approx(euler / (0.699155658 * 0.699155658)).epsilon(1e-8));
  // Held at both ends no node moves at all: the member buckles between them.
  const auto inside = buckling_modes(Column(L, fixed, held({0, 1, 3, 4, 5})).model, at_head(0, 0, -P), 1, {});
  REQUIRE(inside.size() == 1);
  CHECK(inside[0].factor == Approx(4 * euler).epsilon(1e-9));
  CHECK(inside[0].shape[1].isZero(0));
  // Under its own weight a standing cantilever buckles at q L = 7.8373 EI/L2 (Timoshenko and Gere, 2.11).
  LoadSet weight;
  BeamLoad load;
  load.beam = 0;
  load.to = L;
  load.first(0) = load.last(0) = -100;
  weight.beams.push_back(load);
  CHECK(lowest(Column(L, fixed, Vec6::Zero()).model, weight) * 100 * L ==
        Approx(7.8373 * 2e11 * 3e-5 / (L * L)).epsilon(1e-5));
}

TEST_CASE("buckling factors come in order with their shapes: a cantilever about its weak and its strong axis") {
  const double L = 5, P = 1000, weak = pi * pi * 2e11 * 3e-5 / (4 * L * L) / P;
  const auto modes = buckling_modes(Column(L, fixed, Vec6::Zero()).model, at_head(0, 0, -P), 3, {});
  REQUIRE(modes.size() == 3);
  CHECK(modes[0].factor == Approx(weak).epsilon(1e-9));
  CHECK(modes[1].factor == Approx(weak * 1e-4 / 3e-5).epsilon(1e-9));
  CHECK(modes[2].factor == Approx(9 * weak).epsilon(1e-9));
  CHECK(std::abs(modes[0].shape[1](1)) == Approx(1).epsilon(1e-6));
  CHECK(std::abs(modes[1].shape[1](0)) == Approx(1).epsilon(1e-6));
  CHECK(buckling_modes(Column(L, fixed, Vec6::Zero()).model, at_head(0, 0, P), 1, {}).empty());  // pulled: never
}

TEST_CASE("loads beyond the critical ones have no second-order answer") {
  const double L = 5, critical = pi * pi * 2e11 * 3e-5 / (4 * L * L);
  const FrameModel model = Column(L, fixed, Vec6::Zero()).model;
  CHECK_NOTHROW(solve(model, at_head(1, 1, -0.999 * critical)));
  CHECK_THROWS_AS(solve(model, at_head(1, 1, -1.001 * critical)), Buckled);
  CHECK_THROWS_AS(solve(model, at_head(1, 1, -30 * critical)), Buckled);
  const FrameModel held_column = Column(L, fixed, held({0, 1, 3, 4, 5})).model;
  CHECK_NOTHROW(solve(held_column, at_head(0, 0, -15.9 * critical)));
  CHECK_THROWS_AS(solve(held_column, at_head(0, 0, -16.1 * critical)), Buckled);
}

TEST_CASE("a pin-ended bar under tension resists being turned as a string does, and a leaning column pushes") {
  // A cantilever beside a leaning, pin-ended column that carries the load: sway H / (3 EI/L3 - P/L), first order in the
  // cantilever, which carries nothing.
  const double L = 4, P = 2e5, H = 1e3;
  FrameModel model = Column(L, fixed, Vec6::Zero()).model;
  model.supports.pop_back();
  model.nodes.push_back(Vec3(5, 0, 0));
  model.nodes.push_back(Vec3(5, 0, L));
  Beam leaning = model.beams[0];
  leaning.node = {2, 3};
  for (Vec6& end : leaning.end_stiffness) end(4) = end(5) = 0;
  Beam link = model.beams[0];
  link.node = {1, 3};
  link.length = 5;
  link.axes = Mat3::Identity();
  link.area = 1e3;
  for (Vec6& end : link.end_stiffness) end(4) = end(5) = 0;
  model.beams.push_back(leaning);
  model.beams.push_back(link);
  model.supports = {{0, fixed}, {2, held({0, 1, 2, 3, 4, 5})}, {3, held({1, 3, 4, 5})}};
  LoadSet loads = at_head(H, 0, 0);
  NodeLoad down{3, Vec6::Zero()};
  for (const double p : {P, -P}) {
    down.load(2) = -p;
    LoadSet all = loads;
    all.nodes.push_back(down);
    const double sway = H / (3 * 2e11 * 1e-4 / (L * L * L) - p / L);
    CHECK(solve(model, all).solution.displacements[1](0) == Approx(sway).epsilon(1e-5));  // the link stretches a little
    CHECK(solve(model, all, SecondOrder::cubic).solution.displacements[1](0) == Approx(sway).epsilon(1e-5));
  }
}
