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

TEST_CASE("a patch of which nothing is kept moves with nothing, and is deformed by what acts on it") {
  Superelement::Patch own = patch();
  own.kept.clear();
  const Superelement element(own);
  const std::vector<Vec6> loads = loads_on(wall(), {});
  CHECK(element.stiffness().size() == 0);
  CHECK(element.condense(loads).size() == 0);
  const Eigen::MatrixXd shapes = element.shapes();
  CHECK(shapes.rows() == 6 * static_cast<Eigen::Index>(own.nodes.size()));
  CHECK(shapes.cols() == 0);
  const std::vector<Vec6> moved = element.recover({}, loads);
  CHECK(moved[static_cast<std::size_t>(number(columns, rows))].norm() > 0);
}

TEST_CASE("a copy of a superelement loses shells of its own, and is what a new one is then") {
  const Superelement whole(patch());
  Superelement copy(whole), fresh(patch());
  copy.remove(hole());
  fresh.remove(hole());
  const std::vector<Vec6> loads = loads_on(wall(), hole());
  CHECK(copy.stiffness() == fresh.stiffness());
  CHECK(copy.condense(loads) == fresh.condense(loads));
  CHECK_FALSE(copy.stands(hole().front()));
  // The one that it was copied from stands as it did.
  const Superelement other(patch());
  CHECK(whole.stands(hole().front()));
  CHECK(whole.stiffness() == other.stiffness());
  CHECK(whole.condense(loads) == other.condense(loads));
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

namespace {

/// Posts and a beam around a wall, node for node along its sides and its top, and a storey upon them: with the wall's
/// mesh, and with its superelement in the mesh's place.
struct FramedWall {
  FrameModel meshed, condensed;
  std::vector<int> kept;  ///< of the wall: nodes that posts and beams have too, by their number in the patch
  Superelement::Patch patch;
};

FramedWall framed_wall() {
  FramedWall both;
  FrameModel& model = both.meshed;
  model = wall();
  model.supports = {{number(0, 0), fixed()}, {number(columns, 0), fixed()}};
  for (int i = 0; i < columns; ++i) add_beam(model, number(i, rows), number(i + 1, rows));
  for (int j = 0; j < rows; ++j) {
    add_beam(model, number(0, j), number(0, j + 1));
    add_beam(model, number(columns, j), number(columns, j + 1));
  }
  // A storey above it, so that there is more than the wall.
  const Vec3 up(0, 0, 3);
  const std::array<int, 3> feet{number(0, rows), number(4, rows), number(columns, rows)};
  for (const int foot : feet) {
    model.nodes.push_back(model.nodes[static_cast<std::size_t>(foot)] + up);
    add_beam(model, foot, static_cast<int>(model.nodes.size()) - 1);
  }
  const int top = static_cast<int>(model.nodes.size());
  add_beam(model, top - 3, top - 2);
  add_beam(model, top - 2, top - 1);
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= columns; ++i)
      if (j == rows || i == 0 || i == columns) both.kept.push_back(number(i, j));
  both.patch.nodes.assign(model.nodes.begin(), model.nodes.begin() + number(columns, rows) + 1);
  both.patch.shells = model.shells;
  both.patch.kept = both.kept;
  both.condensed = model;
  both.condensed.shells.clear();
  both.condensed.patches = {{both.kept, Superelement(both.patch).stiffness()}};
  return both;
}

}  // namespace

TEST_CASE("a patch that shares its edges with beams moves as its mesh does, and changes as a fresh one is") {
  const FramedWall walls = framed_wall();
  // Nodes inside the wall have no stiffness of their own in the condensed model.
  std::vector<int> inner;
  for (int n = 0; n <= number(columns, rows); ++n)
    if (std::find(walls.kept.begin(), walls.kept.end(), n) == walls.kept.end()) inner.push_back(n);
  Superelement element(walls.patch);
  Reanalysis standing(walls.condensed);
  standing.drop_nodes(inner);
  const int top = static_cast<int>(walls.meshed.nodes.size()) - 2;
  const auto compare = [&](const std::vector<int>& gone) {
    const std::vector<Vec6> own = loads_on(wall(), gone);
    FrameModel left = walls.meshed;
    left.shells.clear();
    std::vector<char> has(left.nodes.size(), 0);
    for (std::size_t k = 0; k < walls.meshed.shells.size(); ++k) {
      if (std::find(gone.begin(), gone.end(), static_cast<int>(k)) != gone.end()) continue;
      left.shells.push_back(walls.meshed.shells[k]);
      for (const int node : left.shells.back().node) has[static_cast<std::size_t>(node)] = 1;
    }
    LoadSet set;
    set.nodes.push_back({top, unit(1, 4e4)});
    for (std::size_t n = 0; n < own.size(); ++n) {
      set.nodes.push_back({static_cast<int>(n), own[n]});
      if (!has[n] && std::find(inner.begin(), inner.end(), static_cast<int>(n)) != inner.end())
        left.supports.push_back({static_cast<int>(n), fixed()});
    }
    const StaticSolution expected = solve_one(left, set);
    standing.set_node_load(top, unit(1, 4e4));
    const Eigen::VectorXd condensed = element.condense(own);
    for (std::size_t k = 0; k < walls.kept.size(); ++k)
      standing.set_node_load(walls.kept[k], condensed.segment<6>(static_cast<Eigen::Index>(6 * k)));
    REQUIRE(standing.solve().stable);
    double largest = 0, difference = 0, force = 0, off = 0;
    for (const int node : walls.kept) {
      const auto n = static_cast<std::size_t>(node);
      largest = std::max(largest, expected.displacements[n].norm());
      difference = std::max(difference, (standing.displacements()[n] - expected.displacements[n]).norm());
    }
    for (int s = 0; s < 2; ++s) {
      force = std::max(force, expected.reactions[static_cast<std::size_t>(s)].norm());
      off = std::max(off, (standing.reaction(s) - expected.reactions[static_cast<std::size_t>(s)]).norm());
    }
    CHECK(largest > 1e-4);
    CHECK(difference < 1e-9 * largest);  // rounding of a condition of about 1e6
    CHECK(off < 1e-8 * force);
  };
  compare({});
  const std::uint64_t factors = standing.counters().refactorisations;
  element.remove(hole());
  standing.set_patch_stiffness(0, element.stiffness());
  compare(hole());
  // Broken away from its right edge altogether.
  std::vector<int> most = hole();
  for (int j = 0; j < rows; ++j) most.push_back(j * columns + columns - 1);
  std::sort(most.begin(), most.end());
  element.remove(most);
  standing.set_patch_stiffness(0, element.stiffness());
  compare(most);
  CHECK(standing.counters().refactorisations <= factors + 2);
  CHECK_THROWS_AS(standing.set_patch_stiffness(0, Eigen::MatrixXd::Zero(6, 6)), std::invalid_argument);
  CHECK_THROWS_AS(standing.set_patch_stiffness(1, Eigen::MatrixXd::Zero(6, 6)), std::invalid_argument);
}

TEST_CASE("a sheet among many that is softened by little is corrected for, without a new factor") {
  // Twelve by twelve bays of posts with a floor of sheets: a change of one is a small part of it.
  FrameModel model;
  constexpr int bays = 12;
  const auto at = [](int i, int j, int k) { return (k * (bays + 1) + j) * (bays + 1) + i; };
  for (int k = 0; k < 2; ++k)
    for (int j = 0; j <= bays; ++j)
      for (int i = 0; i <= bays; ++i) model.nodes.emplace_back(4.0 * i, 4.0 * j, 3.0 * k);
  for (int j = 0; j <= bays; ++j)
    for (int i = 0; i <= bays; ++i) {
      add_beam(model, at(i, j, 0), at(i, j, 1));
      model.supports.push_back({at(i, j, 0), fixed()});
      if (i < bays) add_beam(model, at(i, j, 1), at(i + 1, j, 1));
      if (j < bays) add_beam(model, at(i, j, 1), at(i, j + 1, 1));
    }
  Shell sheet;
  sheet.youngs_modulus = 30e9;
  sheet.poisson_ratio = 0.2;
  sheet.thickness = 0.2;
  for (int j = 0; j < bays; ++j)
    for (int i = 0; i < bays; ++i) {
      sheet.node = {at(i, j, 1), at(i + 1, j, 1), at(i + 1, j + 1, 1), at(i, j + 1, 1)};
      model.shells.push_back(sheet);
    }
  Reanalysis standing(model);
  standing.set_node_load(at(6, 6, 1), unit(0, 5e5));
  REQUIRE(standing.solve().stable);
  const auto factors = standing.counters().refactorisations;
  const auto K = standing.shell_stiffness(70);
  for (const double left : {0.4, 0.1}) {
    standing.set_shell_stiffness(70, left * K);
    REQUIRE(standing.solve().stable);
    FrameModel softer = model;
    softer.shell_stiffness.emplace(70, left * K);
    LoadSet set;
    set.nodes.push_back({at(6, 6, 1), unit(0, 5e5)});
    const StaticSolution expected = solve_one(softer, set);
    double largest = 0, difference = 0;
    for (std::size_t n = 0; n < model.nodes.size(); ++n) {
      largest = std::max(largest, expected.displacements[n].norm());
      difference = std::max(difference, (standing.displacements()[n] - expected.displacements[n]).norm());
    }
    CHECK(difference < 1e-10 * largest);
  }
  CHECK(standing.counters().refactorisations == factors);
  // Taken away, as one that was whole before would be.
  standing.remove_shell(70);
  REQUIRE(standing.solve().stable);
  CHECK(standing.shell_corner_forces(70)[0].norm() == 0);
}
