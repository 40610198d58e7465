// What breaks may leave a node that has neither stiffness nor mass in a direction, or a part without mass on nothing:
// both leave the equations, and the rest moves as if they had never been.
#include <catch2/catch.hpp>

#include "frames.h"
#include "topple/solver/frame_dynamics.h"

using namespace topple::test;

namespace {

constexpr double spring = 4e6, mass = 500, push = 3e4;  // N/m, kg, N
constexpr int held = 0, loose = 1;

/// Four nodes of a membrane that resists in its plane alone: a mass on a spring along `along`, a node on a beam of its
/// own, and two fixed ones. Node 4 is where the beam is fixed.
struct Membrane {
  FrameModel model;
  MassModel masses;
  Vec3 along;

  explicit Membrane(const Mat3& turned, bool first_held = true) : along(turned.col(0)) {
    for (const Vec3& place : {Vec3(0, 0, 0), Vec3(2, 0, 0), Vec3(2, 2, 0), Vec3(0, 2, 0), Vec3(2, 0, 3)})
      model.nodes.emplace_back(turned * place);
    add_beam(model, loose, 4);
    model.beams[0].density = 7850;
    for (const int node : {2, 3, 4}) model.supports.push_back({node, fixed()});
    Shell membrane;
    membrane.node = {0, 1, 2, 3};
    membrane.youngs_modulus = 30e9;
    membrane.poisson_ratio = 0.2;
    membrane.thickness = 0.2;
    model.shells.push_back(membrane);
    // In the plane alone: a spring between the first two nodes, and one from each to the ground of the others.
    Eigen::Matrix<double, 24, 24> K = Eigen::Matrix<double, 24, 24>::Zero();
    const auto tie = [&](Eigen::Index a, Eigen::Index b, const Vec3& d, double k) {
      K.block<3, 3>(6 * a, 6 * a) += k * d * d.transpose();
      K.block<3, 3>(6 * b, 6 * b) += k * d * d.transpose();
      K.block<3, 3>(6 * a, 6 * b) -= k * d * d.transpose();
      K.block<3, 3>(6 * b, 6 * a) -= k * d * d.transpose();
    };
    tie(held, loose, along, 1e8);
    if (first_held) {
      tie(loose, 2, turned.col(1), 1e8);
      tie(held, 3, turned.col(1), 1e8);
      tie(held, 3, along, spring);
    }
    model.shell_stiffness[0] = K;
    if (first_held) masses.nodes.push_back({held, mass, Vec3::Zero()});
  }
};

Mat3 turn(double angle) { return Eigen::AngleAxisd(angle, Vec3(0.3, 1, -0.2).normalized()).toRotationMatrix(); }

DynamicOptions fine() {
  DynamicOptions options;
  options.substep = 1.0 / 2000;
  options.spectral_radius = 1;
  return options;
}

void lose_beam(FrameDynamics& frame) {
  for (int end = 0; end < 2; ++end) frame.set_end_stiffness(0, end, Vec6::Zero());
}

}  // namespace

TEST_CASE("A node that a break leaves on a membrane alone follows it, and has no part in what the membrane lets be") {
  const double angle = GENERATE(0.0, 0.7);
  INFO("turned by " << angle);
  const Membrane built(turn(angle));
  FrameDynamics frame(built.model, built.masses, fine());
  const Vec3 across = turn(angle).col(2);
  Vec6 load = Vec6::Zero();
  load.head<3>() = -2000 * across;
  frame.set_node_load(loose, load);
  for (int n = 0; n < 50; ++n) frame.advance();
  REQUIRE(std::abs(across.dot(frame.displacements()[loose].head<3>())) > 1e-7);
  const double stored = frame.energy().kinetic + frame.energy().elastic;
  lose_beam(frame);
  frame.set_node_load(loose, Vec6::Zero());
  frame.advance();
  CHECK(std::abs(across.dot(frame.displacements()[loose].head<3>())) < 1e-12);
  // What it had across went with the beam; nothing came from holding it.
  CHECK(frame.energy().freed > 0);
  CHECK(frame.energy().freed < stored * (1 + 1e-9));
  const DynamicEnergy& e = frame.energy();
  CHECK(std::abs(e.kinetic + e.elastic + e.damped + e.numerical + e.freed - e.external_work) < 1e-9 * stored);

  // The mass on its spring, pushed at once from rest: u = (1 - cos wt) P / k.
  frame.set_state(std::vector<Vec6>(5, Vec6::Zero()), std::vector<Vec6>(5, Vec6::Zero()));
  load.head<3>() = push * built.along;
  frame.set_node_load(held, load);
  const double start = frame.time();
  for (int n = 0; n < 200; ++n) frame.advance();
  const double w = std::sqrt(spring / mass);
  const double exact = push / spring * (1 - std::cos(w * (frame.time() - start)));
  // Second order in wh = 0.045: a shift of phase of (wh)^2 / 12 a radian, 9 radians on, and the first half substep,
  // in which the acceleration rises from 0: wh / 2 of the swing.
  CHECK(std::abs(built.along.dot(frame.displacements()[held].head<3>()) - exact) < 0.03 * push / spring);
  CHECK((frame.displacements()[loose] - frame.displacements()[held]).head<3>().norm() < 1e-9);
}

TEST_CASE("A part without mass that a break leaves on nothing is left out, and loads on it go with it") {
  Membrane built(turn(0.4), false);
  built.model.supports.clear();
  built.model.supports.push_back({4, fixed()});
  // The fixed nodes are none here: two of the membrane's corners hang on beams without mass.
  add_beam(built.model, 2, loose);
  add_beam(built.model, 3, held);
  add_beam(built.model, held, 4);
  built.model.beams.back().density = 7850;
  // Beside it a cantilever that goes on.
  built.model.nodes.emplace_back(0, 0, 9);
  add_beam(built.model, 4, 5);
  built.model.beams.back().density = 7850;
  FrameDynamics frame(built.model, built.masses, fine());
  frame.set_node_load(5, unit(0, 100));
  frame.set_node_load(2, unit(2, -100));
  for (int n = 0; n < 20; ++n) frame.advance();
  lose_beam(frame);
  for (int end = 0; end < 2; ++end) frame.set_end_stiffness(3, end, Vec6::Zero());
  for (int n = 0; n < 20; ++n) REQUIRE_NOTHROW(frame.advance());
  for (const int node : {0, 1, 2, 3}) CHECK(frame.displacements()[static_cast<std::size_t>(node)].norm() == 0);
  FrameModel alone;
  alone.nodes = {built.model.nodes[4], built.model.nodes[5]};
  add_beam(alone, 0, 1);
  alone.beams[0].density = 7850;
  alone.supports = {{0, fixed()}};
  FrameDynamics cantilever(alone, {}, fine());
  cantilever.set_node_load(1, unit(0, 100));
  for (int n = 0; n < 40; ++n) cantilever.advance();
  CHECK((frame.displacements()[5] - cantilever.displacements()[1]).norm() <
        1e-9 * cantilever.displacements()[1].norm());
}
