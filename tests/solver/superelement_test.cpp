// A patch of shells condensed to its corners: what is left when elements are taken out must be what a global mesh
// without these elements gives.
#include "topple/solver/superelement.h"

#include <catch2/catch.hpp>

#include "frames.h"
#include "topple/solver/reanalysis.h"

using namespace topple::test;
using topple::solver::Superelement;

namespace {

constexpr int columns = 8, rows = 5;
int number(int i, int j) { return j * (columns + 1) + i; }

/// A wall of 6 m x 3 m in a skew plane.
FrameModel wall() {
  FrameModel model;
  const Vec3 along = Vec3(0.8, 0.6, 0), up = Vec3(-0.12, 0.16, 0.98).normalized();
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= columns; ++i) model.nodes.push_back(6.0 * i / columns * along + 3.0 * j / rows * up);
  Shell shell;
  shell.youngs_modulus = 30e9;
  shell.poisson_ratio = 0.2;
  shell.thickness = 0.2;
  shell.bending = true;
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      shell.node = {number(i, j), number(i + 1, j), number(i + 1, j + 1), number(i, j + 1)};
      model.shells.push_back(shell);
    }
  return model;
}

std::vector<int> hole() {
  std::vector<int> gone;
  for (int j = 1; j < 4; ++j)
    for (int i = 2; i < 5; ++i) gone.push_back(j * columns + i);
  return gone;
}

std::vector<int> corners() { return {number(0, 0), number(columns, 0), number(columns, rows), number(0, rows)}; }

Superelement::Patch patch() {
  const FrameModel mesh = wall();
  Superelement::Patch patch;
  patch.nodes = mesh.nodes;
  patch.shells = mesh.shells;
  patch.kept = corners();
  for (int i = 1; i < columns; ++i) patch.supports.push_back({number(i, 0), Vec6::Constant(rigid)});
  return patch;
}

/// Weight and a push out of the plane on every element that stands.
std::vector<Vec6> loads_on(const FrameModel& mesh, const std::vector<int>& gone) {
  std::vector<Vec6> loads(mesh.nodes.size(), Vec6::Zero());
  for (std::size_t k = 0; k < mesh.shells.size(); ++k) {
    if (std::find(gone.begin(), gone.end(), static_cast<int>(k)) != gone.end()) continue;
    const auto own = topple::solver::traction_loads(mesh, static_cast<int>(k), Vec3(300, -400, -5000));
    for (std::size_t n = 0; n < 4; ++n) loads[static_cast<std::size_t>(mesh.shells[k].node[n])] += own[n];
  }
  return loads;
}

/// The global mesh, with the wall standing on its lower edge and its corners on posts beside it.
struct Global {
  std::vector<Vec6> displacements;
  std::vector<Vec6> reactions;
};
Global global_answer(const std::vector<int>& gone) {
  FrameModel mesh = wall();
  const std::vector<Vec6> loads = loads_on(mesh, gone);
  std::vector<char> has(mesh.nodes.size(), 0);
  FrameModel left = mesh;
  left.shells.clear();
  for (std::size_t k = 0; k < mesh.shells.size(); ++k) {
    if (std::find(gone.begin(), gone.end(), static_cast<int>(k)) != gone.end()) continue;
    left.shells.push_back(mesh.shells[k]);
    for (const int node : mesh.shells[k].node) has[static_cast<std::size_t>(node)] = 1;
  }
  for (int i = 0; i <= columns; ++i) left.supports.push_back({number(i, 0), Vec6::Constant(rigid)});
  LoadSet set;
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n) {
    if (!has[n]) left.supports.push_back({static_cast<int>(n), Vec6::Constant(rigid)});
    set.nodes.push_back({static_cast<int>(n), loads[n]});
  }
  const StaticSolution solution = solve_one(left, set);
  return {solution.displacements, solution.reactions};
}

/// The same seen through the superelement: four nodes and one element in the frame.
void check(const std::vector<int>& gone) {
  Superelement element(patch());
  if (!gone.empty()) element.remove(gone);
  const FrameModel mesh = wall();
  const std::vector<Vec6> loads = loads_on(mesh, gone);
  const Global expected = global_answer(gone);

  FrameModel frame;
  for (const int corner : corners()) frame.nodes.push_back(mesh.nodes[static_cast<std::size_t>(corner)]);
  Shell shell = mesh.shells.front();
  shell.node = {0, 1, 2, 3};
  frame.shells = {shell};
  frame.supports = {{0, Vec6::Constant(rigid)}, {1, Vec6::Constant(rigid)}};
  Reanalysis standing(frame);
  standing.set_shell_stiffness(0, element.stiffness());
  const Eigen::VectorXd condensed = element.condense(loads);
  for (int c = 0; c < 4; ++c) standing.set_node_load(c, condensed.segment<6>(6 * c));
  REQUIRE(standing.solve().stable);

  Eigen::VectorXd kept(24);
  for (int c = 0; c < 4; ++c) kept.segment<6>(6 * c) = standing.displacements()[static_cast<std::size_t>(c)];
  const std::vector<Vec6> inner = element.recover(kept, loads);
  double largest = 0, difference = 0;
  for (std::size_t n = 0; n < inner.size(); ++n) {
    largest = std::max(largest, expected.displacements[n].norm());
    difference = std::max(difference, (inner[n] - expected.displacements[n]).norm());
  }
  CHECK(largest > 1e-6);
  CHECK(difference < 1e-9 * largest);
  // What the supports bear, node for node along the lower edge.
  const std::vector<Vec6> reactions = element.reactions(inner, loads);
  double force = 0, off = 0;
  for (int i = 0; i <= columns; ++i) {
    const Vec6& own = expected.reactions[static_cast<std::size_t>(i)];
    force = std::max(force, own.norm());
    off = std::max(off, (reactions[static_cast<std::size_t>(number(i, 0))] - own).norm());
  }
  CHECK(off < 1e-9 * force);
}

}  // namespace

TEST_CASE("a superelement is what its global mesh is, whole and with a hole") {
  check({});
  check(hole());
}

TEST_CASE("what a hole cuts off from everything that holds it leaves the superelement") {
  Superelement element(patch());
  // A ring of elements around one: the one in the middle hangs on nothing.
  std::vector<int> ring;
  for (int j = 1; j < 4; ++j)
    for (int i = 2; i < 5; ++i)
      if (i != 3 || j != 2) ring.push_back(j * columns + i);
  element.remove(ring);
  CHECK_FALSE(element.stands(2 * columns + 3));
  CHECK(element.stands(0));
  CHECK(element.has_shells(number(0, 0)));
  CHECK_FALSE(element.has_shells(number(3, 2)));
}

TEST_CASE("a tied edge stays straight: the patch is no softer than with free edges, and moves with its corners") {
  Superelement::Patch free = patch(), tied = patch();
  free.supports.clear();
  tied.supports.clear();
  for (int i = 1; i < columns; ++i) {
    tied.ties.push_back({number(i, 0), {0, 1}, static_cast<double>(i) / columns});
    tied.ties.push_back({number(i, rows), {3, 2}, static_cast<double>(i) / columns});
  }
  const Superelement soft(free), stiff(tied);
  const Eigen::MatrixXd difference = stiff.stiffness() - soft.stiffness();
  Eigen::VectorXd u(24);
  for (int seed = 0; seed < 8; ++seed) {
    for (int k = 0; k < 24; ++k) u(k) = std::sin(1.7 * k + seed);
    CHECK(u.dot(difference * u) >= 0);
  }
  // A rigid translation costs nothing.
  u.setZero();
  for (int c = 0; c < 4; ++c) u(6 * c + 1) = 1;
  CHECK((stiff.stiffness() * u).norm() < 1e-9 * stiff.stiffness().norm());
}

TEST_CASE("of a shell's stiffness as much is left as of its material") {
  Superelement::Patch free = patch();
  free.supports.clear();
  const Superelement whole(free);
  Superelement half(free), holed(free), by_share(free);
  half.keep(std::vector<double>(free.shells.size(), 0.5));
  CHECK((half.stiffness() - 0.5 * whole.stiffness()).norm() < 1e-10 * whole.stiffness().norm());
  std::vector<double> share(free.shells.size(), 1);
  for (const int shell : hole()) share[static_cast<std::size_t>(shell)] = 0;
  by_share.keep(share);
  holed.remove(hole());
  CHECK((by_share.stiffness() - holed.stiffness()).norm() == 0);
  share[0] = 1.5;
  CHECK_THROWS_AS(by_share.keep(share), std::invalid_argument);
}

TEST_CASE("a given stiffness swells when heated as the element it was taken from") {
  // A sheet of 3 m x 2 m held at one corner and on rollers at the others, which springs hold back.
  FrameModel plain;
  plain.nodes = {Vec3(0, 0, 0), Vec3(3, 0, 0), Vec3(3, 2, 0), Vec3(0, 2, 0)};
  Shell sheet;
  sheet.node = {0, 1, 2, 3};
  sheet.youngs_modulus = 30e9;
  sheet.poisson_ratio = 0.2;
  sheet.thickness = 0.1;
  plain.shells = {sheet};
  plain.supports.push_back({0, Vec6::Constant(rigid)});
  for (int n = 1; n < 4; ++n) {
    Vec6 held = Vec6::Constant(rigid);
    held(0) = held(1) = 2e9;
    plain.supports.push_back({n, held});
  }
  FrameModel given = plain;
  given.shell_stiffness.emplace(0, Reanalysis(plain).shell_stiffness(0));
  LoadSet heat;
  heat.shells = {{0, Vec3::Zero(), 1e-3}};
  const StaticSolution expected = solve_one(plain, heat), found = solve_one(given, heat);
  CHECK(expected.displacements[2].norm() > 1e-4);
  for (std::size_t n = 0; n < 4; ++n) {
    CHECK((found.displacements[n] - expected.displacements[n]).norm() < 1e-10 * 1e-3);
    CHECK((found.shell_corner_forces[0][n] - expected.shell_corner_forces[0][n]).norm() <
          1e-9 * expected.shell_corner_forces[0][2].norm());
  }
  heat.shells = {{0, Vec3(0, 0, 1), 0}};
  CHECK_THROWS_AS(solve_one(given, heat), std::invalid_argument);
}
