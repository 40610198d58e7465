// Single beams against closed forms of beam theory (any structures text; Timoshenko's shear terms as in Gere and
// Timoshenko, Mechanics of Materials). Nodal answers of an exact element differ by rounding alone: 1e-12 relative,
// where the issue of digits is only the condition of a one-beam matrix.
#include <catch2/catch.hpp>

#include "frames.h"

using namespace topple::test;

namespace {
constexpr double tolerance = 1e-12;
constexpr double L = 4.0;
}  // namespace

TEST_CASE("a cantilever's tip moves by bending and shear in both planes, each with its own inertia and shear area") {
  const FrameModel model = single_beam(L, fixed(), Vec6::Zero());
  const Beam& b = model.beams[0];
  const double E = b.youngs_modulus, G = b.shear_modulus, P = 1000;
  LoadSet loads;
  loads.nodes = {{1, components(P, 2 * P, 3 * P, 4 * P, 0, 0)}};
  const StaticSolution s = solve_one(model, loads);
  const Vec6& tip = s.displacements[1];
  CHECK(tip(0) == Approx(P * L / (E * b.area)).epsilon(tolerance));
  CHECK(tip(1) == Approx(2 * P * (L * L * L / (3 * E * b.Iz) + L / (G * b.shear_area_y))).epsilon(tolerance));
  CHECK(tip(2) == Approx(3 * P * (L * L * L / (3 * E * b.Iy) + L / (G * b.shear_area_z))).epsilon(tolerance));
  CHECK(tip(3) == Approx(4 * P * L / (G * b.J)).epsilon(tolerance));
  CHECK(tip(4) == Approx(-3 * P * L * L / (2 * E * b.Iy)).epsilon(tolerance));
  CHECK(tip(5) == Approx(2 * P * L * L / (2 * E * b.Iz)).epsilon(tolerance));
  const Vec6 reaction = components(-P, -2 * P, -3 * P, -4 * P, 3 * P * L, -2 * P * L);
  CHECK((s.reactions[0] - reaction).cwiseAbs().maxCoeff() < tolerance * 3 * P * L);
}

TEST_CASE("a cantilever under uniform load sags by q L4/8EI + q L2/2GA") {
  const FrameModel model = single_beam(L, fixed(), Vec6::Zero());
  const Beam& b = model.beams[0];
  const double q = -700;
  LoadSet loads;
  loads.beams = {uniform_load(0, L, components(0, 2 * q, q, 0, 0, 0))};
  const Vec6 tip = solve_one(model, loads).displacements[1];
  const double E = b.youngs_modulus, G = b.shear_modulus;
  CHECK(tip(2) == Approx(q * (std::pow(L, 4) / (8 * E * b.Iy) + L * L / (2 * G * b.shear_area_z))).epsilon(tolerance));
  CHECK(tip(1) ==
        Approx(2 * q * (std::pow(L, 4) / (8 * E * b.Iz) + L * L / (2 * G * b.shear_area_y))).epsilon(tolerance));
}

TEST_CASE("end moments of a fixed beam under uniform load are q L2/12, with signs by the right hand") {
  const FrameModel model = single_beam(L, fixed(), fixed());
  const double q = 900;
  LoadSet loads;
  loads.beams = {uniform_load(0, L, components(0, q, -q, 0, 0, 0))};
  const StaticSolution s = solve_one(model, loads);
  const double M = q * L * L / 12;
  const Vec12& f = s.beam_end_forces[0];
  CHECK(f(2) == Approx(q * L / 2).epsilon(tolerance));
  CHECK(f(4) == Approx(-M).epsilon(tolerance));
  CHECK(f(10) == Approx(M).epsilon(tolerance));
  CHECK(f(1) == Approx(-q * L / 2).epsilon(tolerance));
  CHECK(f(5) == Approx(-M).epsilon(tolerance));
  CHECK(f(11) == Approx(M).epsilon(tolerance));
  CHECK((s.reactions[0] - f.head<6>()).norm() == 0);
  CHECK((s.reactions[1] - f.tail<6>()).norm() == 0);
}

TEST_CASE("a propped cantilever without shear deformation bears 5/8 and 3/8 of a uniform load") {
  FrameModel model = single_beam(L, fixed(), components(0, 0, rigid, 0, 0, 0));
  model.beams[0].shear_area_y = model.beams[0].shear_area_z = 0;
  const double q = 1300;
  LoadSet loads;
  loads.beams = {uniform_load(0, L, unit(2, -q))};
  const StaticSolution s = solve_one(model, loads);
  CHECK(s.reactions[0](2) == Approx(5 * q * L / 8).epsilon(tolerance));
  CHECK(s.reactions[1](2) == Approx(3 * q * L / 8).epsilon(tolerance));
  CHECK(s.reactions[0](4) == Approx(-q * L * L / 8).epsilon(tolerance));
}

TEST_CASE("a released end gives the propped cantilever as well, its node free to turn") {
  FrameModel model = single_beam(L, fixed(), fixed());
  model.beams[0].shear_area_y = model.beams[0].shear_area_z = 0;
  model.beams[0].end_stiffness[1](4) = 0;
  const double q = 1300;
  LoadSet loads;
  loads.beams = {uniform_load(0, L, unit(2, -q))};
  const StaticSolution s = solve_one(model, loads);
  CHECK(s.reactions[0](2) == Approx(5 * q * L / 8).epsilon(tolerance));
  CHECK(s.reactions[1](2) == Approx(3 * q * L / 8).epsilon(tolerance));
  CHECK(s.beam_end_forces[0](10) == 0);
}

TEST_CASE("rotational end springs share the fixed-end moment as slope deflection says") {
  FrameModel model = single_beam(L, fixed(), fixed());
  Beam& b = model.beams[0];
  b.shear_area_y = b.shear_area_z = 0;
  const double EI = b.youngs_modulus * b.Iz, q = 500;
  for (double k : {1e-6 * EI / L, EI / L, 1e7 * EI / L}) {
    b.end_stiffness[0](5) = b.end_stiffness[1](5) = k;
    LoadSet loads;
    loads.beams = {uniform_load(0, L, unit(1, -q))};
    // Symmetric: M (1/k + L/2EI) = q L3/24EI.
    const double M = q * L * L * L / (24 * EI) / (1 / k + L / (2 * EI));
    CHECK(solve_one(model, loads).beam_end_forces[0](5) == Approx(M).epsilon(tolerance));
  }
}

TEST_CASE("a settlement of one fixed end bends the beam by 6 E I d/L2, shear included") {
  const FrameModel model = single_beam(L, fixed(), fixed());
  const Beam& b = model.beams[0];
  const double d = -0.01, EI = b.youngs_modulus * b.Iy;
  const double phi = 12 * EI / (b.shear_modulus * b.shear_area_z * L * L);
  LoadSet loads;
  loads.settlements = {{1, 2, d}};
  const StaticSolution s = solve_one(model, loads);
  CHECK(s.displacements[1](2) == d);
  CHECK(s.reactions[1](2) == Approx(12 * EI * d / (L * L * L * (1 + phi))).epsilon(tolerance));
  CHECK(s.reactions[0](4) == Approx(6 * EI * d / (L * L * (1 + phi))).epsilon(tolerance));
}

TEST_CASE("temperature pushes on held ends and bends held ones, a free beam grows and curves without force") {
  const Beam b = single_beam(L, fixed(), fixed()).beams[0];
  BeamLoad heat;
  heat.beam = 0;
  heat.kind = BeamLoad::Kind::temperature;
  heat.strain = 2.4e-4;
  heat.curvature_y = 3e-4;
  heat.curvature_z = 5e-4;
  LoadSet loads;
  loads.beams = {heat};
  const StaticSolution held = solve_one(single_beam(L, fixed(), fixed()), loads);
  const double E = b.youngs_modulus;
  CHECK(held.reactions[0](0) == Approx(E * b.area * heat.strain).epsilon(tolerance));
  // Hotter on top (+z), the held beam wants to arch up: the internal moment My is -E Iy kappa all along.
  CHECK(held.beam_end_forces[0](4) == Approx(E * b.Iy * heat.curvature_z).epsilon(tolerance));
  CHECK(held.beam_end_forces[0](5) == Approx(-E * b.Iz * heat.curvature_y).epsilon(tolerance));
  const StaticSolution free = solve_one(single_beam(L, fixed(), Vec6::Zero()), loads);
  CHECK(free.displacements[1](0) == Approx(heat.strain * L).epsilon(tolerance));
  // Hotter on top the free cantilever curls down, away from the hot side.
  CHECK(free.displacements[1](2) == Approx(-heat.curvature_z * L * L / 2).epsilon(tolerance));
  CHECK(free.displacements[1](1) == Approx(-heat.curvature_y * L * L / 2).epsilon(tolerance));
  // Force against the size of what held ends would feel: rounding.
  CHECK(free.beam_end_forces[0].cwiseAbs().maxCoeff() < 1e-9 * E * b.area * heat.strain);
}

TEST_CASE("a partial trapezoid load equals many point loads at the limit of their number") {
  const FrameModel model = single_beam(L, fixed(), components(0, rigid, rigid, 0, 0, 0));
  BeamLoad trapezoid;
  trapezoid.beam = 0;
  trapezoid.from = 0.7;
  trapezoid.to = 2.9;
  trapezoid.first = components(100, 200, -300, 40, 50, -60);
  trapezoid.last = components(-50, 400, 100, 10, -20, 30);
  LoadSet distributed, points;
  distributed.beams = {trapezoid};
  // Gauss points of each slice would be exact sooner; the midpoint rule errs by (slice/L)^2 / 24 of the load's
  // curvature.
  const int slices = 2000;
  const double width = (trapezoid.to - trapezoid.from) / slices;
  for (int i = 0; i < slices; ++i) {
    const double share = (i + 0.5) / slices;
    const Vec6 value = width * (trapezoid.first + share * (trapezoid.last - trapezoid.first));
    points.beams.push_back(point_load(0, trapezoid.from + share * (trapezoid.to - trapezoid.from), value));
  }
  const Vec12 a = solve_one(model, distributed).beam_end_forces[0];
  const Vec12 b = solve_one(model, points).beam_end_forces[0];
  CHECK((a - b).cwiseAbs().maxCoeff() < 1e-6 * a.cwiseAbs().maxCoeff());
}

TEST_CASE("rigid arms carry a tip load to the node with its lever") {
  FrameModel model = single_beam(L, fixed(), Vec6::Zero());
  Beam& b = model.beams[0];
  const Vec3 arm(-0.5, 0.2, 0.3);  // from node 1 to the beam's end: the node hangs off the beam
  b.offset[1] = arm;
  b.length = 0;
  const Vec3 along = model.nodes[1] + arm - model.nodes[0];
  b.length = along.norm();
  const Vec3 x = along / b.length, y = Vec3::UnitZ().cross(x).normalized();
  b.axes << x.transpose(), y.transpose(), x.cross(y).transpose();
  LoadSet loads;
  const Vec6 load = components(10, 20, 30, 0, 0, 0);
  loads.nodes = {{1, load}};
  const StaticSolution s = solve_one(model, loads);
  // The same cantilever loaded at its own end by the force and its moment about that end.
  FrameModel bare;
  bare.nodes = {model.nodes[0], model.nodes[1] + arm};
  bare.beams = {b};
  bare.beams[0].offset[1].setZero();
  bare.supports = {{0, fixed()}};
  LoadSet moved;
  Vec6 at_end = load;
  at_end.tail<3>() = (-arm).cross(Vec3(load.head<3>()));
  moved.nodes = {{1, at_end}};
  const StaticSolution t = solve_one(bare, moved);
  const Vec6& u = t.displacements[1];
  Vec6 expected = u;
  expected.head<3>() += Vec3(u.tail<3>()).cross(-arm);
  CHECK((s.displacements[1] - expected).norm() < 1e-11 * expected.norm());
  CHECK((s.beam_end_forces[0] - t.beam_end_forces[0]).norm() < 1e-11 * t.beam_end_forces[0].norm());
}
