// Shells in meshes: one element for a panel, balance, instability. (Published answers are in tests/verification.)
#include <catch2/catch.hpp>

#include "solver/frames.h"
#include "verification/shell_grid.h"

using namespace topple::test;

TEST_CASE("one membrane element for a panel bends in its plane without locking") {
  // Pure bending by end couples, as forces at the corners: exact for a rectangle but for the Poisson bow of its ends,
  // nu2 (b/a)2/2 of the answer at most.
  const double a = 6, b = 3, t = 0.2, E = 30e9, nu = 0.2;
  ShellGrid mesh = shell_grid(1, 1, E, nu, t, false, [&](double s, double r) { return Vec3(a * s, b * r, 0); });
  for (int n = 0; n < 4; ++n) mesh.model.supports.push_back({n, components(0, 0, rigid, 0, 0, 0)});
  mesh.model.supports.push_back({mesh.node(0, 0), components(rigid, rigid, 0, 0, 0, 0)});
  mesh.model.supports.push_back({mesh.node(0, 1), components(rigid, 0, 0, 0, 0, 0)});
  const double M = 1e6;
  LoadSet loads;
  loads.nodes = {{mesh.node(1, 0), unit(0, M / b)}, {mesh.node(1, 1), unit(0, -M / b)}};
  const StaticSolution s = solve_one(mesh.model, loads);
  const double EI = E * t * b * b * b / 12;
  CHECK(s.displacements[static_cast<std::size_t>(mesh.node(1, 0))](1) == Approx(M * a * a / (2 * EI)).epsilon(0.02));
}

TEST_CASE("a freedom that only a membrane reaches is unstable, and the node is named") {
  ShellGrid mesh = shell_grid(1, 1, 30e9, 0.2, 0.2, false, [](double s, double t) { return Vec3(s, t, 0); });
  for (int n : {0, 1}) mesh.model.supports.push_back({n, fixed()});
  mesh.model.supports.push_back({mesh.node(1, 1), components(0, 0, rigid, 0, 0, 0)});
  try {
    StaticAnalysis analysis(mesh.model);
    FAIL("accepted");
  } catch (const Instability& e) {
    CHECK(e.mechanism.nodes == std::vector<int>{mesh.node(0, 1)});
  }
}

TEST_CASE("shell corner forces balance loads and reactions, also under a diaphragm and a settlement") {
  ShellGrid mesh = shell_grid(3, 2, 30e9, 0.2, 0.15, true,
                              [](double s, double t) { return Vec3(4 * s, 0.3 * s + 2.5 * t, 0.2 * s * t); });
  mesh.model.supports = {{mesh.node(0, 0), fixed()},
                         {mesh.node(0, 2), components(0, 0, rigid, 0, 0, 0)},
                         {mesh.node(3, 1), components(0, 1e6, 1e7, 0, 0, 0)}};
  LoadSet loads;
  for (int s = 0; s < 6; ++s) loads.shells.push_back({s, Vec3(100, 200, -3000), 1e-5});
  loads.settlements = {{mesh.node(0, 2), 2, -0.002}};
  for (bool diaphragm : {false, true}) {
    if (diaphragm) mesh.model.diaphragms = {{{mesh.node(2, 0), mesh.node(2, 1), mesh.node(2, 2)}}};
    const StaticSolution s = solve_one(mesh.model, loads);
    CHECK(s.quality.backward_error <= 1e-14);
    Vec3 load = Vec3::Zero(), reaction = Vec3::Zero(), corners = Vec3::Zero();
    for (const auto& shell : mesh.model.shells) {
      const Vec3 d1 = mesh.model.nodes[static_cast<std::size_t>(shell.node[2])] -
                      mesh.model.nodes[static_cast<std::size_t>(shell.node[0])];
      const Vec3 d2 = mesh.model.nodes[static_cast<std::size_t>(shell.node[3])] -
                      mesh.model.nodes[static_cast<std::size_t>(shell.node[1])];
      load += d1.cross(d2).norm() / 2 * Vec3(100, 200, -3000);
    }
    for (const Vec6& r : s.reactions) reaction += r.head<3>();
    for (const auto& shell : s.shell_corner_forces) {
      for (const Vec6& f : shell) corners += f.head<3>();
    }
    CHECK((load + reaction).norm() < 1e-9 * load.norm());
    // What the nodes do to the shells is what carries the loads on them.
    CHECK((load + corners).norm() < 1e-9 * load.norm());
  }
}
