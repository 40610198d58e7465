// Buckling of frames and plates, one member for each column, against the roots of their characteristic equations.
#include "topple/solver/buckling.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "topple/solver/second_order.h"

using namespace topple::solver;

namespace {

constexpr double pi = 3.14159265358979323846;
const Vec6 fixed = Vec6::Constant(rigid);

Vec6 held(std::initializer_list<int> components) {
  Vec6 k = Vec6::Zero();
  for (int c : components) k(c) = rigid;
  return k;
}

/// A portal in the x-z plane: columns of height h, a beam of span b as stiff over its length as the columns are.
FrameModel portal(double h, double b, bool fixed_bases, bool sway) {
  FrameModel model;
  model.nodes = {Vec3(0, 0, 0), Vec3(0, 0, h), Vec3(b, 0, h), Vec3(b, 0, 0)};
  const auto add = [&](int from, int to, double I) {
    Beam beam;
    beam.node = {from, to};
    const Vec3 axis = model.nodes[static_cast<std::size_t>(to)] - model.nodes[static_cast<std::size_t>(from)];
    beam.length = axis.norm();
    beam.axes.row(0) = axis.normalized();
    beam.axes.row(1) = Vec3(0, 1, 0);
    beam.axes.row(2) = beam.axes.row(0).cross(beam.axes.row(1));
    beam.youngs_modulus = 2e11;
    beam.shear_modulus = 8e10;
    beam.area = 10;  // so stiff along that only bending counts
    beam.Iy = I;
    beam.Iz = 1;  // so stiff across that the plane is kept
    beam.J = 1;
    model.beams.push_back(beam);
  };
  add(0, 1, 1e-4);
  add(1, 2, 1e-4 * b / h);
  add(3, 2, 1e-4);
  const Vec6 base = fixed_bases ? fixed : held({0, 1, 2, 3, 5});
  model.supports = {{0, base}, {3, base}};
  for (const int head : {1, 2}) model.supports.push_back({head, sway ? held({1, 3, 5}) : held({0, 1, 3, 5})});
  return model;
}

double lowest(const FrameModel& model, const LoadSet& loads) {
  const auto modes = buckling_modes(model, loads, 1, {});
  REQUIRE(modes.size() == 1);
  return modes[0].factor;
}

/// Root of f in a bracket, by halving.
template <class Function>
double root(double low, double high, const Function& f) {
  const bool rises = f(high) > f(low);
  for (int k = 0; k < 200; ++k) {
    const double middle = (low + high) / 2;
    ((f(middle) > 0) == rises ? high : low) = middle;
  }
  return low;
}

}  // namespace

TEST_CASE("portals with one member for each column buckle at the roots of their characteristic equations") {
  const double h = 4, b = 7, P = 1000, EI = 2e11 * 1e-4;
  LoadSet loads;
  for (const int head : {1, 2}) {
    NodeLoad load{head, Vec6::Zero()};
    load.load(2) = -P;
    loads.nodes.push_back(load);
  }
  const auto factor = [&](double kh) { return kh * kh * EI / (h * h) / P; };
  // Timoshenko and Gere, 2.4 and 2.16: the beam in double curvature holds a head by 6 EI/b, in single by 2 EI/b.
  const double pinned_sway = root(0.5, 1.5, [](double a) { return a * std::tan(a) - 6; });
  const double fixed_sway = root(1.6, 3.1, [](double a) { return a / std::tan(a) + 6; });
  const double pinned_held = root(pi * 1.001, 4.4, [](double a) { return a * a / (1 - a / std::tan(a)) + 2; });
  // The axial stiffness of 2e12 N against forces of some 1e7 N moves the factors by some 1e-6.
  CHECK(lowest(portal(h, b, false, true), loads) == Approx(factor(pinned_sway)).epsilon(1e-5));
  CHECK(lowest(portal(h, b, true, true), loads) == Approx(factor(fixed_sway)).epsilon(1e-5));
  CHECK(lowest(portal(h, b, false, false), loads) == Approx(factor(pinned_held)).epsilon(1e-5));
  CHECK(fixed_sway * fixed_sway == Approx(7.379).epsilon(1e-3));  // as it is printed there
}

namespace {

/// A simply supported square plate in the x-y plane, pressed along x by 1 per length.
struct PressedPlate {
  FrameModel model;
  LoadSet loads;
  explicit PressedPlate(int n, double side, double t) {
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= n; ++i) {
        const int node = static_cast<int>(model.nodes.size());
        model.nodes.push_back(Vec3(side * i / n, side * j / n, 0));
        Vec6 k = Vec6::Zero();
        if (i == 0 || i == n || j == 0 || j == n) k(2) = rigid;
        if (2 * i == n) k(0) = rigid;
        if (2 * j == n) k(1) = rigid;
        model.supports.push_back({node, k});
        if (i != 0 && i != n) continue;
        NodeLoad load{node, Vec6::Zero()};
        load.load(0) = (i == 0 ? 1 : -1) * side / n * (j == 0 || j == n ? 0.5 : 1);
        loads.nodes.push_back(load);
      }
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        const int first = j * (n + 1) + i;
        model.shells.push_back({{first, first + 1, first + n + 2, first + n + 1}, 2e11, 0.3, t, 0, true});
      }
  }
};

}  // namespace

TEST_CASE("a plate under pressure along one side buckles at 4 pi2 D/b2, and not when it is pulled") {
  const double side = 1.2, t = 0.01, D = 2e11 * t * t * t / (12 * (1 - 0.09));
  const double closed = 4 * pi * pi * D / (side * side);
  const double coarse = lowest(PressedPlate(6, side, t).model, PressedPlate(6, side, t).loads);
  const double fine = lowest(PressedPlate(12, side, t).model, PressedPlate(12, side, t).loads);
  // Bilinear shapes: (pi/n)^2/12 of the geometric stiffness and as much again of the bending: 5 % and a quarter of it.
  CHECK(coarse == Approx(closed).epsilon(0.05));
  CHECK(fine == Approx(closed).epsilon(0.0125));
  PressedPlate pulled(4, side, t);
  for (NodeLoad& load : pulled.loads.nodes) load.load *= -1;
  CHECK(buckling_modes(pulled.model, pulled.loads, 1, {}, 10 * closed).empty());
}

TEST_CASE("membrane forces soften a plate by 1/(1 - P/Pcr), and their answer ends at Pcr") {
  PressedPlate plate(8, 1.2, 0.01);
  const double critical = lowest(plate.model, plate.loads);
  const auto sag = [&](double share) {
    LoadSet loads = plate.loads;
    for (NodeLoad& load : loads.nodes) load.load *= share * critical;
    NodeLoad push{40, Vec6::Zero()};  // the centre
    push.load(2) = -1;
    loads.nodes.push_back(push);
    const StaticSolution linear = StaticAnalysis(plate.model).solve({&loads, 1}).front();
    return SecondOrderAnalysis(plate.model, SecondOrder::exact).solve(loads, linear).solution.displacements[40](2);
  };
  // A load at the centre is not the buckling shape alone: the first mode has 79 % of its sag (1/0.0116 over 4 pi^4).
  const double share = 0.5, first = 4 / (4 * std::pow(pi, 4)) / 0.0116008;
  CHECK(sag(share) / sag(0) > 1 + first * share / (1 - share));
  CHECK(sag(share) / sag(0) < 1 / (1 - share));
  CHECK_NOTHROW(sag(0.999));
  CHECK_THROWS_AS(sag(1.001), Buckled);
}

TEST_CASE("columns that buckle at hardly different loads are told apart, as far as their number goes") {
  // Six cantilevers in a row, each with its own load, two the same, some 1e-9 or 1e-8 apart; each buckles in two planes
  // that are 1e-8 apart: 12 factors in all.
  FrameModel model;
  LoadSet loads;
  const double base = 1000;
  std::vector<double> expected;
  for (const double share : {1.0, 1.0, 1 - 1e-9, 1 - 1e-8, 0.99, 0.5}) {
    const int foot = static_cast<int>(model.nodes.size());
    model.nodes.emplace_back(1.5 * foot, 0, 0);
    model.nodes.emplace_back(1.5 * foot, 0, 4);
    Beam beam;
    beam.node = {foot, foot + 1};
    beam.length = 4;
    beam.axes << 0, 0, 1, 0, 1, 0, -1, 0, 0;
    beam.youngs_modulus = 2e11;
    beam.shear_modulus = 8e10;
    beam.area = 0.01;
    beam.Iy = 1e-5;
    beam.Iz = 1e-5 * (1 + 1e-8);
    beam.J = 1e-5;
    model.beams.push_back(beam);
    model.supports.push_back({foot, fixed});
    NodeLoad load{foot + 1, Vec6::Zero()};
    load.load(2) = -base * share;
    loads.nodes.push_back(load);
    for (const double I : {beam.Iy, beam.Iz})
      expected.push_back(pi * pi * beam.youngs_modulus * I / (4 * 16) / (base * share));
  }
  std::sort(expected.begin(), expected.end());
  const auto modes = buckling_modes(model, loads, static_cast<int>(expected.size()), {});
  REQUIRE(modes.size() == expected.size());
  // Where Newton's method cannot tell shapes apart, factors are enclosed to 2e-9 of themselves.
  for (std::size_t k = 0; k < modes.size(); ++k) CHECK(modes[k].factor == Approx(expected[k]).epsilon(4e-9));
}

TEST_CASE("a post between held ends bulges in its middle, a freedom that buckles alone") {
  FrameModel model;
  const double length = 6, EI = 2e11 * 1e-5;
  model.nodes = {Vec3(0, 0, 0), Vec3(0, 0, length / 2), Vec3(0, 0, length)};
  for (const int from : {0, 1}) {
    Beam beam;
    beam.node = {from, from + 1};
    beam.length = length / 2;
    beam.axes << 0, 0, 1, 1, 0, 0, 0, 1, 0;
    beam.youngs_modulus = 2e11;
    beam.shear_modulus = 8e10;
    beam.area = 0.01;
    beam.Iy = 1e-5;
    beam.Iz = 3e-5;
    beam.J = 1e-5;
    model.beams.push_back(beam);
  }
  model.supports = {{0, fixed}, {2, held({0, 1, 3, 4, 5})}};
  LoadSet loads;
  loads.nodes = {{2, Vec6::Unit(2) * -1000}};
  const auto modes = buckling_modes(model, loads, 2, {});
  REQUIRE(modes.size() == 2);
  // 4 pi2 EI / L2, then with a turning middle at the first root of tan x = x, 4 x2 EI / L2. To some enclosures' width
  // (1e-11).
  const double turning = 4.4934094579090642;
  CHECK(modes[0].factor == Approx(4 * pi * pi * EI / (length * length) / 1000).epsilon(1e-10));
  CHECK(modes[1].factor == Approx(4 * turning * turning * EI / (length * length) / 1000).epsilon(1e-10));
  // About the weak axis, global x: the middle moves along global y without turning, then turns without moving.
  const Vec6 &first = modes[0].shape[1], &second = modes[1].shape[1];
  CHECK(std::abs(first(1)) > 0);
  CHECK(std::abs(first(0)) < 1e-6 * std::abs(first(1)));
  CHECK(std::abs(first(3)) * length < 1e-6 * std::abs(first(1)));
  CHECK(std::abs(second(3)) > 0);
  CHECK(second.head<3>().norm() < 1e-6 * length * std::abs(second(3)));
}

TEST_CASE("a factor below the limit is found when only one beyond it is what an estimate leads to") {
  // A slender post between a fixed foot and the end of a stiff bracket: by itself it buckles at 4 pi2 EI/L2 of what it
  // bears; the nodes move at a far larger factor.
  FrameModel model;
  model.nodes = {Vec3(0, 0, 0), Vec3(0, 0, 6), Vec3(4, 0, 6)};
  const auto bar = [&](int from, int to, double length, double I, double area) {
    Beam beam;
    beam.node = {from, to};
    beam.length = length;
    if (from == 0) beam.axes << 0, 0, 1, 0, 1, 0, -1, 0, 0;
    beam.youngs_modulus = 2e11;
    beam.shear_modulus = 8e10;
    beam.area = area;
    beam.Iy = beam.Iz = beam.J = I;
    model.beams.push_back(beam);
  };
  bar(0, 1, 6, 3e-6, 2e-3);
  bar(1, 2, 4, 3e-3, 5e-2);
  model.supports = {{0, fixed}, {2, fixed}};
  LoadSet loads;
  loads.nodes = {{1, Vec6::Unit(2) * -1.2e6}};
  const auto all = buckling_modes(model, loads, 1, {});
  REQUIRE(all.size() == 1);
  REQUIRE(all[0].factor < 1);
  for (const double limit : {1.0, 1.5, 2.0, 3.0, 1e3}) {
    const auto modes = buckling_modes(model, loads, 1, {}, limit);
    CAPTURE(limit);
    REQUIRE(modes.size() == 1);
    CHECK(modes[0].factor == Approx(all[0].factor).epsilon(1e-10));
  }
  CHECK(buckling_modes(model, loads, 1, {}, 0.5 * all[0].factor).empty());
}
