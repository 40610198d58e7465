// Floors that are rigid in their plane, against the same frame with stiff members in the floor and against statics.
#include <catch2/catch.hpp>

#include "frames.h"

using namespace topple::test;

namespace {

/// Four posts of unequal stiffness under a floor, no beams.
FrameModel floor_on_posts() {
  FrameModel model;
  const double x[4] = {0, 6, 6, 0}, y[4] = {0, 0, 4, 4};
  for (int i = 0; i < 4; ++i) model.nodes.emplace_back(x[i], y[i], 0);
  for (int i = 0; i < 4; ++i) model.nodes.emplace_back(x[i], y[i], 3);
  for (int i = 0; i < 4; ++i) {
    add_beam(model, i, i + 4);
    model.beams.back().Iy *= 1 + i;
    model.beams.back().Iz *= 2 + 0.5 * i;
    model.supports.push_back({i, fixed()});
  }
  return model;
}

}  // namespace

TEST_CASE("the nodes of a diaphragm move as a rigid body in x, y and rz, and are free otherwise") {
  FrameModel model = floor_on_posts();
  model.diaphragms = {{{4, 5, 6, 7}}};
  LoadSet loads;
  loads.nodes = {{5, components(0, 5000, -1000, 0, 0, 0)}};
  const StaticSolution s = solve_one(model, loads);
  const double spin = s.displacements[4](5);
  CHECK(std::abs(spin) > 1e-6);
  for (int n : {5, 6, 7}) {
    const Vec3 arm = model.nodes[static_cast<std::size_t>(n)] - model.nodes[4];
    const Vec6& u = s.displacements[static_cast<std::size_t>(n)];
    CHECK(u(5) == Approx(spin).epsilon(1e-13));
    CHECK(u(0) - s.displacements[4](0) == Approx(-arm.y() * spin).epsilon(1e-10).margin(1e-16));
    CHECK(u(1) - s.displacements[4](1) == Approx(arm.x() * spin).epsilon(1e-10));
  }
  CHECK(s.displacements[5](2) == Approx(-1000 * 3 / (210e9 * 8.5e-3)).epsilon(1e-10));
  CHECK(s.displacements[6](2) == Approx(0).margin(1e-18));
  Balance balance;
  balance.add(model.nodes[5], loads.nodes[0].load);
  for (int i = 0; i < 4; ++i)
    balance.add(model.nodes[static_cast<std::size_t>(i)], s.reactions[static_cast<std::size_t>(i)]);
  CHECK(balance.error() < 1e-10);
}

TEST_CASE("a diaphragm equals a floor of beams stiff in its plane") {
  FrameModel bound = floor_on_posts(), braced = floor_on_posts();
  bound.diaphragms = {{{4, 5, 6, 7}}};
  // Ten thousand times stiffer than the posts in axial force and in bending about z, free in all else: differences of
  // 1e-4.
  for (const auto& [a, b] : {std::pair(4, 5), std::pair(5, 6), std::pair(6, 7), std::pair(7, 4), std::pair(4, 6)}) {
    add_beam(braced, a, b);
    Beam& beam = braced.beams.back();
    beam.area = 1e2;
    beam.Iz = 1e2;
    beam.shear_area_y = beam.shear_area_z = 0;
    beam.Iy = beam.J = 1e-12;
  }
  LoadSet loads;
  loads.nodes = {{7, components(3000, 1000, 0, 0, 0, 500)}};
  const StaticSolution a = solve_one(bound, loads), b = solve_one(braced, loads);
  for (std::size_t n = 4; n < 8; ++n) {
    for (int c : {0, 1, 5}) {
      CHECK(b.displacements[n](c) == Approx(a.displacements[n](c)).epsilon(1e-3).margin(1e-8));
    }
  }
}

TEST_CASE("supports that hold a diaphragm's nodes bear what the floor brings them") {
  FrameModel model = floor_on_posts();
  model.diaphragms = {{{4, 5, 6, 7}}};
  // Held against x at two corners of different y: against rotation as well.
  model.supports.push_back({4, unit(0, rigid)});
  model.supports.push_back({6, unit(0, rigid)});
  LoadSet loads;
  loads.nodes = {{7, components(1000, 0, 0, 0, 0, 0)}};
  const StaticSolution s = solve_one(model, loads);
  for (std::size_t n = 4; n < 8; ++n) {
    CHECK(s.displacements[n](0) == Approx(0).margin(1e-18));
    CHECK(s.displacements[n](5) == Approx(0).margin(1e-18));
  }
  CHECK(s.reactions[5](0) == Approx(-1000).epsilon(1e-10));
  CHECK(s.reactions[4](0) == Approx(0).margin(1e-7));
  LoadSet settled;
  settled.settlements = {{4, 0, 0.01}, {6, 0, 0.03}};
  const StaticSolution t = solve_one(model, settled);
  CHECK(t.displacements[4](0) == Approx(0.01).epsilon(1e-12));
  CHECK(t.displacements[7](0) == Approx(0.03).epsilon(1e-12));
  CHECK(t.displacements[5](5) == Approx(-0.02 / 4).epsilon(1e-12));
}

TEST_CASE("a node in two diaphragms is refused") {
  FrameModel model = floor_on_posts();
  model.diaphragms = {{{4, 5}}, {{5, 6}}};
  CHECK_THROWS_WITH(StaticAnalysis(model), Catch::Contains("node 5"));
}
