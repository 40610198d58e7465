// A patch with mass moves as what it stands for.
#include <catch2/catch.hpp>

#include "frames.h"
#include "topple/solver/frame_dynamics.h"

using namespace topple::test;

namespace {

constexpr double density = 7850;

/// Two posts and a beam between their tops; the beam is a beam, or a patch of the same matrices.
FrameModel portal_model() {
  FrameModel model;
  model.nodes = {Vec3(0, 0, 0), Vec3(4, 0, 0), Vec3(0, 0, 3), Vec3(4, 0, 3)};
  model.supports = {{0, fixed()}, {1, fixed()}};
  add_beam(model, 0, 2);
  add_beam(model, 1, 3);
  add_beam(model, 2, 3);
  for (Beam& beam : model.beams) beam.density = density;
  return model;
}

/// K of the beam along x in the freedoms of its nodes, by unit displacements of held nodes; M by its closed form.
Patch patch_of_beam(const Beam& beam) {
  Patch patch;
  patch.node = {2, 3};
  patch.stiffness.resize(12, 12);
  patch.mass = Eigen::MatrixXd::Zero(12, 12);
  FrameModel alone;
  alone.nodes = {Vec3(0, 0, 0), Vec3(beam.length, 0, 0)};
  alone.beams = {beam};
  alone.beams[0].node = {0, 1};
  alone.supports = {{0, fixed()}, {1, fixed()}};
  for (int j = 0; j < 12; ++j) {
    LoadSet load;
    load.settlements = {{j / 6, j % 6, 1}};
    const StaticSolution solution = solve_one(alone, load);
    patch.stiffness.col(j) << solution.reactions[0], solution.reactions[1];
  }
  const double m = beam.density * beam.area * beam.length, L = beam.length;
  const auto set = [&](int i, int j, double value) { patch.mass(i, j) = patch.mass(j, i) = value; };
  set(0, 0, m / 3), set(6, 6, m / 3), set(0, 6, m / 6);
  const double polar = beam.density * (beam.Iy + beam.Iz) * L;
  set(3, 3, polar / 3), set(9, 9, polar / 3), set(3, 9, polar / 6);
  for (const auto& [v, r, sense] : {std::tuple(1, 5, 1.0), std::tuple(2, 4, -1.0)}) {  // v' = rz, w' = -ry
    set(v, v, 156 * m / 420), set(v + 6, v + 6, 156 * m / 420), set(v, v + 6, 54 * m / 420);
    set(v, r, sense * 22 * m * L / 420), set(v + 6, r + 6, -sense * 22 * m * L / 420);
    set(v, r + 6, -sense * 13 * m * L / 420), set(r, v + 6, sense * 13 * m * L / 420);
    set(r, r, 4 * m * L * L / 420), set(r + 6, r + 6, 4 * m * L * L / 420), set(r, r + 6, -3 * m * L * L / 420);
  }
  return patch;
}

FrameModel with_patch() {
  FrameModel model = portal_model();
  model.patches = {patch_of_beam(model.beams[2])};
  model.beams.pop_back();
  return model;
}

}  // namespace

TEST_CASE("Natural frequencies and motion of a frame with a beam are those with a patch of its matrices") {
  const std::vector<VibrationMode> beam = natural_modes(portal_model(), {}, 4, {}).modes,
                                   patch = natural_modes(with_patch(), {}, 4, {}).modes;
  REQUIRE(beam.size() == patch.size());
  // The rest is rotational inertia and shear of the beam's mass, which the patch of this test leaves out.
  for (std::size_t i = 0; i < beam.size(); ++i)
    CHECK(patch[i].angular_frequency == Approx(beam[i].angular_frequency).epsilon(2e-3));

  DynamicOptions options;
  options.substep = 1.0 / 480;
  FrameDynamics first(portal_model(), {}, options), second(with_patch(), {}, options);
  double largest = 0, off = 0;
  for (FrameDynamics* frame : {&first, &second}) frame->set_node_load(2, components(3e4, 1e4, -2e4, 0, 0, 0));
  for (int n = 0; n < 200; ++n) {
    first.advance();
    second.advance();
    const Vec6 a = first.displacements()[3], b = second.displacements()[3];
    largest = std::max(largest, a.head<3>().norm());
    off = std::max(off, (a - b).head<3>().norm());
  }
  CHECK(off < 0.01 * largest);
  const Vec6 moving = second.patch_momentum(0);
  CHECK((first.beam_momentum(2) - moving).head<3>().norm() < 0.02 * moving.head<3>().norm());
  CHECK((first.momentum() - second.momentum()).head<3>().norm() < 0.02 * second.momentum().head<3>().norm());
}

TEST_CASE("A patch whose mass goes takes its energy along, and its nodes move on with the velocity that they have") {
  DynamicOptions options;
  options.substep = 1.0 / 480;
  FrameModel model = with_patch();
  FrameDynamics frame(model, {}, options);
  frame.set_node_load(2, components(3e4, 1e4, -2e4, 0, 0, 0));
  for (int n = 0; n < 50; ++n) frame.advance();
  const double kinetic = frame.energy().kinetic;
  const std::vector<Vec6> v = frame.velocities();
  Eigen::VectorXd at(12);
  at << v[2], v[3];
  const double own = at.dot(model.patches[0].mass * at) / 2;
  frame.set_patch_mass(0, Eigen::MatrixXd::Zero(12, 12));
  frame.strike({});
  CHECK(frame.velocities()[2] == v[2]);
  CHECK(frame.energy().kinetic == Approx(kinetic - own).epsilon(1e-9));
  CHECK(frame.energy().freed == Approx(own).epsilon(1e-9));
  CHECK(frame.patch_momentum(0).isZero(0));
  CHECK_THROWS_AS(frame.set_patch_mass(0, Eigen::MatrixXd::Zero(6, 6)), std::invalid_argument);
  CHECK_THROWS_AS(frame.set_patch_mass(1, Eigen::MatrixXd::Zero(12, 12)), std::invalid_argument);
}
