// Diagrams along a member against closed forms, and against the nodes of a beam cut in pieces.
#include "topple/solver/beam_diagram.h"

#include <catch2/catch.hpp>
#include <optional>
#include <thread>

#include "frames.h"

using namespace topple::test;

namespace {
constexpr double L = 5.0;
constexpr double tolerance = 1e-12;
}  // namespace

TEST_CASE("a fixed beam under uniform load has q L2/24 in the middle and sags by q L4/384EI + q L2/8GA") {
  const FrameModel model = single_beam(L, fixed(), fixed());
  const Beam& b = model.beams[0];
  const double q = 800;
  LoadSet loads;
  loads.beams = {uniform_load(0, L, components(0, 0, -q, 0, 0, 0))};
  const BeamDiagram diagram(b, solve_one(model, loads).beam_end_forces[0], loads.beams);
  const auto moment = diagram.extremes(BeamDiagram::moment_y);
  // Sagging under load along -z means tension below: the face that looks along +x is turned about -y.
  CHECK(moment.least.value == Approx(-q * L * L / 24).epsilon(tolerance));
  CHECK(moment.least.at == Approx(L / 2).epsilon(1e-7));
  CHECK(moment.greatest.value == Approx(q * L * L / 12).epsilon(tolerance));
  const double sag =
      q * std::pow(L, 4) / (384 * b.youngs_modulus * b.Iy) + q * L * L / (8 * b.shear_modulus * b.shear_area_z);
  CHECK(diagram.value(BeamDiagram::deflection_z, L / 2) == Approx(-sag).epsilon(tolerance));
  CHECK(diagram.extremes(BeamDiagram::deflection_z).least.value == Approx(-sag).epsilon(tolerance));
  CHECK(diagram.value(BeamDiagram::shear_z, 0) == Approx(-q * L / 2).epsilon(tolerance));
  CHECK(diagram.value(BeamDiagram::deflection_y, L / 2) == 0);
}

TEST_CASE("tension is positive, and a point load makes the jump that statics asks for") {
  const FrameModel model = single_beam(L, fixed(), fixed());
  LoadSet loads;
  loads.beams = {point_load(0, 2.0, components(500, 0, 0, 70, 0, 30))};
  const Vec12 f = solve_one(model, loads).beam_end_forces[0];
  const BeamDiagram diagram(model.beams[0], f, loads.beams);
  CHECK(diagram.value(BeamDiagram::axial, 1.0) == Approx(500 * 3.0 / L).epsilon(tolerance));
  CHECK(diagram.value(BeamDiagram::axial, 4.0) == Approx(-500 * 2.0 / L).epsilon(tolerance));
  CHECK(diagram.value(BeamDiagram::torsion, 1.0) - diagram.value(BeamDiagram::torsion, 4.0) ==
        Approx(70).epsilon(tolerance));
  const auto range = diagram.extremes(BeamDiagram::moment_z);
  CHECK(diagram.value(BeamDiagram::moment_z, 2.0) - diagram.value(BeamDiagram::moment_z, 2.0 + 1e-9) ==
        Approx(30).epsilon(1e-6));
  REQUIRE(diagram.breaks() == std::vector<double>{2.0});
  CHECK(diagram.values(2.0)[BeamDiagram::moment_z] - diagram.values(2.0, true)[BeamDiagram::moment_z] ==
        Approx(30).epsilon(tolerance));
  CHECK(diagram.value(BeamDiagram::moment_z, 1.0, true) == diagram.value(BeamDiagram::moment_z, 1.0));
  CHECK(range.greatest.value >= diagram.value(BeamDiagram::moment_z, 2.0));
}

TEST_CASE("what a diagram says inside of a beam is what a node there would see") {
  // One beam with springs, arms' worth of load kinds, and the same beam cut at the distances that are asked for.
  FrameModel whole = single_beam(L, fixed(), components(0, rigid, 0, rigid, 0, 0));
  whole.beams[0].end_stiffness[0](4) = 3e6;
  whole.beams[0].end_stiffness[0](1) = 2e6;
  whole.beams[0].end_stiffness[1](2) = 4e5;
  whole.supports[1].stiffness(2) = 5e5;
  BeamLoad trapezoid = uniform_load(0, L, components(300, 700, -900, 20, 30, 40));
  trapezoid.from = 1.25;
  trapezoid.to = 4.0;
  trapezoid.last = components(-100, 100, 500, 5, -60, 10);
  BeamLoad heat;
  heat.beam = 0;
  heat.kind = BeamLoad::Kind::temperature;
  heat.strain = 1e-4;
  heat.curvature_y = 2e-5;
  heat.curvature_z = -3e-5;
  LoadSet loads;
  loads.beams = {trapezoid, point_load(0, 2.5, components(1000, -2000, 3000, 100, 200, 300)), heat};

  const std::vector<double> cuts{0, 1.25, 2.5, 4.0, L};
  FrameModel cut;
  LoadSet cut_loads;
  for (double x : cuts) cut.nodes.emplace_back(x, 0, 0);
  for (int i = 0; i + 1 < static_cast<int>(cuts.size()); ++i) {
    add_beam(cut, i, i + 1);
    const double a = cuts[static_cast<std::size_t>(i)], b = cuts[static_cast<std::size_t>(i) + 1];
    heat.beam = i;
    cut_loads.beams.push_back(heat);
    if (a < trapezoid.from || b > trapezoid.to) continue;
    const auto at = [&](double x) -> Vec6 {
      return trapezoid.first +
             (trapezoid.last - trapezoid.first) * ((x - trapezoid.from) / (trapezoid.to - trapezoid.from));
    };
    BeamLoad part = uniform_load(i, b - a, at(a));
    part.last = at(b);
    cut_loads.beams.push_back(part);
  }
  cut.beams.front().end_stiffness[0] = whole.beams[0].end_stiffness[0];
  cut.beams.back().end_stiffness[1] = whole.beams[0].end_stiffness[1];
  cut_loads.nodes = {{2, loads.beams[1].first}};
  cut.supports = {whole.supports[0], {4, whole.supports[1].stiffness}};

  const StaticSolution s = solve_one(whole, loads), t = solve_one(cut, cut_loads);
  const double force_scale = t.beam_end_forces[0].norm();
  CHECK((s.beam_end_forces[0].head<6>() - t.beam_end_forces.front().head<6>()).norm() < 1e-11 * force_scale);
  CHECK((s.beam_end_forces[0].tail<6>() - t.beam_end_forces.back().tail<6>()).norm() < 1e-11 * force_scale);
  const BeamDiagram diagram(whole.beams[0], s.beam_end_forces[0], loads.beams);
  Vec12 rigid_ends;
  rigid_ends << s.displacements[0], s.displacements[1];
  for (int n = 1; n < 4; ++n) {
    const double x = cuts[static_cast<std::size_t>(n)];
    const Vec6 u = diagram.displacement(x, rigid_ends);
    CHECK((u - t.displacements[static_cast<std::size_t>(n)]).norm() < 1e-10 * t.displacements[2].norm());
    for (int q = 0; q < 6; ++q) {
      const double inside = diagram.value(static_cast<BeamDiagram::Quantity>(q), x);
      CHECK(inside == Approx(t.beam_end_forces[static_cast<std::size_t>(n) - 1](6 + q)).margin(1e-10 * force_scale));
    }
  }
}

TEST_CASE("extremes bound every value along the beam and are attained") {
  const FrameModel model = single_beam(L, fixed(), fixed());
  LoadSet loads;
  BeamLoad a = uniform_load(0, L, components(10, 500, -300, 5, 0, 0));
  a.from = 0.5;
  a.to = 3.0;
  a.last = components(-40, -700, 900, -20, 30, -10);
  loads.beams = {a, point_load(0, 3.7, components(0, 800, 100, 0, 0, 50))};
  const BeamDiagram diagram(model.beams[0], solve_one(model, loads).beam_end_forces[0], loads.beams);
  for (int q = 0; q < BeamDiagram::quantities; ++q) {
    const auto quantity = static_cast<BeamDiagram::Quantity>(q);
    const auto range = diagram.extremes(quantity);
    const double slack = 1e-12 * std::max(std::abs(range.least.value), std::abs(range.greatest.value));
    double least = 1e300, greatest = -1e300;
    for (int i = 0; i <= 5000; ++i) {
      const double value = diagram.value(quantity, L * i / 5000);
      least = std::min(least, value);
      greatest = std::max(greatest, value);
    }
    CHECK(range.least.value <= least + slack);
    CHECK(range.greatest.value >= greatest - slack);
    // 5000 stations miss a smooth peak by some 1e-7 of it, a jump not at all.
    const double span = range.greatest.value - range.least.value;
    CHECK(range.least.value >= least - 1e-3 * span);
    CHECK(range.greatest.value <= greatest + 1e-3 * span);
  }
}

TEST_CASE("a diagram may outlive what its thread keeps for the next, as one of a program's own does at its end") {
  const FrameModel model = single_beam(L, fixed(), fixed());
  double at_end = 0;
  std::thread([&] {
    struct Late {
      std::optional<BeamDiagram> diagram;
      double* told = nullptr;
      ~Late() { *told = diagram->value(BeamDiagram::axial, 0); }
    };
    thread_local Late late;  // made before the thread's first diagram, and so destroyed after all that goes with these
    late.told = &at_end;
    const Vec12 pulled = (Vec12() << -70, 0, 0, 0, 0, 0, 70, 0, 0, 0, 0, 0).finished();
    late.diagram.emplace(model.beams[0], pulled, std::vector<BeamLoad>());
    const BeamDiagram other(model.beams[0], pulled, std::vector<BeamLoad>());
  }).join();  // one freed twice would end the program here
  CHECK(at_end == 70);
}
