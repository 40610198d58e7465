// Shells in meshes against published answers: MacNeal and Harder 1985 (regular meshes within 2 %), Cook's membrane,
// Timoshenko's plates.
#include <catch2/catch.hpp>

#include "frames.h"

using namespace topple::test;

namespace {

struct Mesh {
  FrameModel model;
  int nx, ny;
  [[nodiscard]] int node(int i, int j) const { return j * (nx + 1) + i; }
};

/// A grid of nx by ny elements over the image of the unit square.
template <class Map>
Mesh grid(int nx, int ny, double E, double nu, double thickness, bool bending, Map map) {
  Mesh mesh{{}, nx, ny};
  for (int j = 0; j <= ny; ++j) {
    for (int i = 0; i <= nx; ++i) mesh.model.nodes.push_back(map(double(i) / nx, double(j) / ny));
  }
  for (int j = 0; j < ny; ++j) {
    for (int i = 0; i < nx; ++i) {
      Shell shell;
      shell.node = {mesh.node(i, j), mesh.node(i + 1, j), mesh.node(i + 1, j + 1), mesh.node(i, j + 1)};
      shell.youngs_modulus = E;
      shell.poisson_ratio = nu;
      shell.thickness = thickness;
      shell.bending = bending;
      mesh.model.shells.push_back(shell);
    }
  }
  return mesh;
}

/// Square plate of side 1: centre deflection over q a4/D, or over P a2/D.
double plate(int n, bool clamped, bool point, double thickness) {
  const double E = 1e9, nu = 0.3, D = E * std::pow(thickness, 3) / (12 * (1 - nu * nu));
  Mesh mesh = grid(n, n, E, nu, thickness, true, [](double s, double t) { return Vec3(s, t, 0); });
  for (int j = 0; j <= n; ++j) {
    for (int i = 0; i <= n; ++i) {
      const bool at_x = i == 0 || i == n, at_y = j == 0 || j == n;
      if (!at_x && !at_y) {
        mesh.model.supports.push_back({mesh.node(i, j), components(rigid, rigid, 0, 0, 0, rigid)});
        continue;
      }
      // Hard simple support: no deflection, no twist along the edge.
      const Vec6 held = clamped ? fixed() : components(rigid, rigid, rigid, at_x ? rigid : 0, at_y ? rigid : 0, rigid);
      mesh.model.supports.push_back({mesh.node(i, j), held});
    }
  }
  LoadSet loads;
  if (point) {
    loads.nodes = {{mesh.node(n / 2, n / 2), unit(2, 1)}};
  } else {
    for (int s = 0; s < n * n; ++s) loads.shells.push_back({s, Vec3(0, 0, 1), 0});
  }
  return solve_one(mesh.model, loads).displacements[static_cast<std::size_t>(mesh.node(n / 2, n / 2))](2) * D;
}

}  // namespace

TEST_CASE("thin plates bend as Timoshenko says, and do not lock at t/a = 1/1000") {
  // 16 x 16: 1 % for distributed loads, 2 % under a point load, where the error is of order h2 log h.
  CHECK(plate(16, false, false, 1e-3) == Approx(0.00406235).epsilon(0.01));
  CHECK(plate(16, true, false, 1e-3) == Approx(0.00126532).epsilon(0.015));
  CHECK(plate(16, false, true, 1e-3) == Approx(0.0116008).epsilon(0.02));
  CHECK(plate(16, true, true, 1e-3) == Approx(0.00561202).epsilon(0.02));
  // A coarse mesh is no stiffer when thin than when moderately thick.
  CHECK(plate(4, true, false, 1e-4) == Approx(plate(4, true, false, 1e-2)).epsilon(0.01));
  // Second order: halving the mesh quarters the error.
  const double coarse = std::abs(plate(8, false, false, 1e-3) - 0.00406235);
  const double fine = std::abs(plate(16, false, false, 1e-3) - 0.00406235);
  CHECK(coarse / fine > 3);
}

TEST_CASE("the straight cantilever of six rectangles bends in its plane, twists and stretches") {
  // MacNeal and Harder: 6 x 0.2 x 0.1, E = 1e7, nu = 0.3, unit loads at the tip.
  Mesh mesh = grid(6, 1, 1e7, 0.3, 0.1, true, [](double s, double t) { return Vec3(6 * s, 0.2 * t, 0); });
  for (int j = 0; j <= 1; ++j) mesh.model.supports.push_back({mesh.node(0, j), fixed()});
  const auto tip = [&](int component) {
    LoadSet loads;
    for (int j = 0; j <= 1; ++j) loads.nodes.push_back({mesh.node(6, j), unit(component, 0.5)});
    const StaticSolution s = solve_one(mesh.model, loads);
    return (s.displacements[static_cast<std::size_t>(mesh.node(6, 0))](component) +
            s.displacements[static_cast<std::size_t>(mesh.node(6, 1))](component)) /
           2;
  };
  CHECK(tip(0) == Approx(3e-5).epsilon(0.02));
  CHECK(tip(1) == Approx(0.1081).epsilon(0.02));
  CHECK(tip(2) == Approx(0.4321).epsilon(0.02));
}

TEST_CASE("one membrane element for a panel bends in its plane without locking") {
  // Pure bending by end couples, as forces at the corners: exact for a rectangle but for the Poisson bow of its ends,
  // nu2 (b/a)2/2 of the answer at most.
  const double a = 6, b = 3, t = 0.2, E = 30e9, nu = 0.2;
  Mesh mesh = grid(1, 1, E, nu, t, false, [&](double s, double r) { return Vec3(a * s, b * r, 0); });
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

TEST_CASE("Cook's membrane converges to 23.96") {
  const auto tip = [](int n) {
    Mesh mesh = grid(n, n, 1, 1.0 / 3, 1, false,
                     [](double s, double t) { return Vec3(48 * s, 44 * s + t * (44 - 28 * s), 0); });
    for (int j = 0; j <= n; ++j) {
      for (int i = 0; i <= n; ++i) {
        const double root = i == 0 ? rigid : 0;
        mesh.model.supports.push_back({mesh.node(i, j), components(root, root, rigid, rigid, rigid, 0)});
      }
    }
    LoadSet loads;
    for (int j = 0; j <= n; ++j) {
      loads.nodes.push_back({mesh.node(n, j), unit(1, (j == 0 || j == n ? 0.5 : 1.0) / n)});
    }
    return solve_one(mesh.model, loads).displacements[static_cast<std::size_t>(mesh.node(n, n / 2))](1);
  };
  CHECK(tip(4) == Approx(23.96).epsilon(0.05));
  CHECK(tip(16) == Approx(23.96).epsilon(0.01));
}

TEST_CASE("the twisted beam and the Scordelis-Lo roof come within 2 %") {
  Mesh twisted = grid(12, 2, 29e6, 0.22, 0.32, true, [](double s, double t) {
    const double angle = s * pi / 2, y = 1.1 * (t - 0.5);
    return Vec3(12 * s, y * std::cos(angle), y * std::sin(angle));
  });
  for (int j = 0; j <= 2; ++j) twisted.model.supports.push_back({twisted.node(0, j), fixed()});
  const auto tip = [&](int component) {
    LoadSet loads;
    for (int j = 0; j <= 2; ++j) loads.nodes.push_back({twisted.node(12, j), unit(component, j == 1 ? 0.5 : 0.25)});
    return solve_one(twisted.model, loads).displacements[static_cast<std::size_t>(twisted.node(12, 1))](component);
  };
  // In plane is along z where the tip's width lies along z.
  CHECK(tip(2) == Approx(0.005424).epsilon(0.02));
  CHECK(tip(1) == Approx(0.001754).epsilon(0.02));

  const int n = 16;
  Mesh roof = grid(n, n, 4.32e8, 0, 0.25, true, [](double s, double t) {
    const double angle = t * 40 * pi / 180;
    return Vec3(25 * s, 25 * std::sin(angle), 25 * std::cos(angle));
  });
  for (int j = 0; j <= n; ++j) {
    for (int i = 0; i <= n; ++i) {
      Vec6 held = Vec6::Zero();
      if (i == 0) held += components(0, rigid, rigid, 0, 0, 0);      // diaphragm at the end
      if (i == n) held += components(rigid, 0, 0, 0, rigid, rigid);  // symmetry at midspan
      if (j == 0) held += components(0, rigid, 0, rigid, 0, rigid);  // symmetry at the crown
      if ((held.array() != 0).any()) roof.model.supports.push_back({roof.node(i, j), held});
    }
  }
  LoadSet weight;
  for (int s = 0; s < n * n; ++s) weight.shells.push_back({s, Vec3(0, 0, -90), 0});
  CHECK(solve_one(roof.model, weight).displacements[static_cast<std::size_t>(roof.node(n, n))](2) ==
        Approx(-0.3024).epsilon(0.02));
}

TEST_CASE("the pinched hemisphere converges to 0.0940 from below") {
  const auto pinched = [](int n) {
    Mesh hemisphere = grid(n, n, 6.825e7, 0.3, 0.04, true, [](double s, double t) {
      const double longitude = s * pi / 2, latitude = t * 72 * pi / 180;
      return Vec3(10 * std::cos(latitude) * std::cos(longitude), 10 * std::cos(latitude) * std::sin(longitude),
                  10 * std::sin(latitude));
    });
    for (int j = 0; j <= n; ++j) {
      hemisphere.model.supports.push_back({hemisphere.node(0, j), components(0, rigid, 0, rigid, 0, rigid)});
      hemisphere.model.supports.push_back({hemisphere.node(n, j), components(rigid, 0, 0, 0, rigid, rigid)});
    }
    hemisphere.model.supports.push_back({hemisphere.node(n / 2, 0), components(0, 0, rigid, 0, 0, 0)});
    LoadSet pinch;
    pinch.nodes = {{hemisphere.node(0, 0), unit(0, 1)}, {hemisphere.node(n, 0), unit(1, -1)}};
    return solve_one(hemisphere.model, pinch).displacements[static_cast<std::size_t>(hemisphere.node(0, 0))](0);
  };
  // Flat facets see the bending rotation of a curved surface as drilling: stiffer than a curved element, of second
  // order.
  const double coarse = pinched(16), fine = pinched(32);
  CHECK(coarse == Approx(0.0940).epsilon(0.05));
  CHECK(fine == Approx(0.0940).epsilon(0.015));
  CHECK(coarse < fine);
}

TEST_CASE("a freedom that only a membrane reaches is unstable, and the node is named") {
  Mesh mesh = grid(1, 1, 30e9, 0.2, 0.2, false, [](double s, double t) { return Vec3(s, t, 0); });
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
  Mesh mesh =
      grid(3, 2, 30e9, 0.2, 0.15, true, [](double s, double t) { return Vec3(4 * s, 0.3 * s + 2.5 * t, 0.2 * s * t); });
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
