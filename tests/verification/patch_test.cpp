// MacNeal and Harder's patch: five distorted elements between prescribed border displacements of a constant strain or
// curvature.
#include <catch2/catch.hpp>

#include "solver/frames.h"
#include "topple/solver/shell_resultants.h"
#include "verification/table.h"

using namespace topple::test;

namespace {

constexpr double E = 1e6, nu = 0.25, thickness = 1e-3;

FrameModel patch() {
  FrameModel model;
  model.nodes = {Vec3(0, 0, 0),       Vec3(0.24, 0, 0),    Vec3(0.24, 0.12, 0), Vec3(0, 0.12, 0),
                 Vec3(0.04, 0.02, 0), Vec3(0.18, 0.03, 0), Vec3(0.16, 0.08, 0), Vec3(0.08, 0.08, 0)};
  for (const std::array<int, 4>& nodes : {std::array{0, 1, 5, 4}, std::array{1, 2, 6, 5}, std::array{2, 3, 7, 6},
                                          std::array{3, 0, 4, 7}, std::array{4, 5, 6, 7}}) {
    Shell shell;
    shell.node = nodes;
    shell.youngs_modulus = E;
    shell.poisson_ratio = nu;
    shell.thickness = thickness;
    shell.bending = true;
    model.shells.push_back(shell);
  }
  for (int n = 0; n < 4; ++n) model.supports.push_back({n, fixed()});
  return model;
}

/// Displacements with the border's prescribed.
template <class Field>
std::vector<Vec6> solve_patch(const FrameModel& model, Field field) {
  LoadSet loads;
  for (int n = 0; n < 4; ++n) {
    const Vec6 u = field(model.nodes[static_cast<std::size_t>(n)]);
    for (int c = 0; c < 6; ++c) loads.settlements.push_back({n, c, u(c)});
  }
  return solve_one(model, loads).displacements;
}

}  // namespace

TEST_CASE("the membrane patch test is exact") {
  const FrameModel model = patch();
  const auto field = [](const Vec3& p) -> Vec6 {
    return 1e-3 * components(p.x() + p.y() / 2, p.y() + p.x() / 2, 0, 0, 0, 0);
  };
  const std::vector<Vec6> u = solve_patch(model, field);
  double worst = 0;
  for (std::size_t n = 4; n < 8; ++n) worst = std::max(worst, (u[n] - field(model.nodes[n])).norm() / u[1].norm());
  judge({"membrane patch, displacements of inner nodes", "MacNeal and Harder 1985", 0, worst}, 1e-9);
  double off = 0;
  for (int s = 0; s < 5; ++s) {
    // 1333, 1333, 400 in global axes: these are those of the constant strain in any axes by its invariants.
    const Vec3 n = topple::solver::shell_resultants(model, s, u).membrane / thickness;
    off = std::max(off, std::abs((n(0) + n(1)) / (2 * E * 1e-3 / (1 - nu)) - 1));
    off = std::max(off, std::abs(std::hypot((n(0) - n(1)) / 2, n(2)) / (E * 1e-3 / (2 * (1 + nu))) - 1));
  }
  judge({"membrane patch, stresses of every element", "MacNeal and Harder 1985", 0, off}, 1e-9);
}

TEST_CASE("the plate patch test is exact") {
  const FrameModel model = patch();
  const auto field = [](const Vec3& p) -> Vec6 {
    const double x = p.x(), y = p.y();
    return 1e-3 * components(0, 0, (x * x + x * y + y * y) / 2, x / 2 + y, -(x + y / 2), 0);
  };
  const std::vector<Vec6> u = solve_patch(model, field);
  double worst = 0;
  for (std::size_t n = 4; n < 8; ++n) worst = std::max(worst, (u[n] - field(model.nodes[n])).norm() / u[1].norm());
  judge({"plate patch, displacements of inner nodes", "MacNeal and Harder 1985", 0, worst}, 1e-9);
  double off = 0;
  for (int s = 0; s < 5; ++s) {
    const ShellResultants r = topple::solver::shell_resultants(model, s, u);
    const double D = E * std::pow(thickness, 3) / (12 * (1 - nu * nu));
    off = std::max(off, std::abs(std::abs(r.moments(0) + r.moments(1)) / (2 * D * (1 + nu) * 1e-3) - 1));
    off = std::max(off,
                   std::abs(std::hypot((r.moments(0) - r.moments(1)) / 2, r.moments(2)) / (D * (1 - nu) * 0.5e-3) - 1));
    off = std::max(off, r.shears.norm() * 0.24 / (D * 1e-3));
  }
  judge({"plate patch, moments and shears of every element", "MacNeal and Harder 1985", 0, off}, 1e-9);
}
