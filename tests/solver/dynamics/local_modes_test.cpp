// How some nodes move while all others are held, against the modes of the same frame with those nodes built in.
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>

#include "frames.h"
#include "topple/solver/frame_dynamics.h"

using namespace topple::test;

namespace {

DynamicOptions undamped() {
  DynamicOptions options;
  options.substep = 1e-3;
  return options;
}

/// Posts of one bay each way and two storeys: node 5 is at the first floor, and four beams meet there.
FrameModel two_storeys() {
  FrameModel model = tower(2, 2);
  for (Beam& beam : model.beams) beam.density = 7850;
  return model;
}

FrameModel with_all_but(FrameModel model, std::span<const int> free) {
  for (int node = 0; node < static_cast<int>(model.nodes.size()); ++node)
    if (std::find(free.begin(), free.end(), node) == free.end()) model.supports.push_back({node, fixed()});
  return model;
}

int first_loose_node(const FrameModel& model) {
  for (int node = 0; node < static_cast<int>(model.nodes.size()); ++node)
    if (std::none_of(model.supports.begin(), model.supports.end(), [&](const Support& s) { return s.node == node; }))
      return node;
  return -1;
}

}  // namespace

TEST_CASE("Local modes are those of the frame whose other nodes are held") {
  const FrameModel model = two_storeys();
  const int at = first_loose_node(model);
  REQUIRE(at >= 0);
  const std::array<int, 1> nodes{at};
  const FrameDynamics frame(model, {}, undamped());
  const LocalModes local = frame.local_modes(nodes, {});
  const ModalAnswer held = natural_modes(with_all_but(model, nodes), {}, 6);
  REQUIRE(local.squared.size() == 6);
  REQUIRE(held.modes.size() == 6);
  // Eigenvalues of well-conditioned matrices; the iteration behind natural_modes stops at about 1e-9.
  for (int k = 0; k < 6; ++k)
    CHECK(std::sqrt(local.squared(k)) ==
          Approx(held.modes[static_cast<std::size_t>(k)].angular_frequency).epsilon(1e-7));
}

TEST_CASE("A push that lasts bends the joints of held nodes by the sum over their modes as statics do") {
  const FrameModel model = two_storeys();
  const int at = first_loose_node(model);
  const std::array<int, 1> nodes{at};
  const FrameDynamics frame(model, {}, undamped());
  Vec6 push;
  push << 3e3, -2e3, 1e3, 500, 700, -900;
  const std::vector<std::vector<FrameDynamics::Impulse>> pushes{{{at, push}}};
  const LocalModes local = frame.local_modes(nodes, pushes);
  const Eigen::VectorXd coordinates = local.pushed.col(0).cwiseQuotient(local.squared);
  LoadSet loads;
  loads.nodes.push_back({at, push});
  const StaticSolution exact = solve_one(with_all_but(model, nodes), loads);
  REQUIRE(!local.end_forces.empty());
  for (const auto& [beam, forces] : local.end_forces) {
    const Vec12 bent = forces * coordinates, expected = exact.beam_end_forces[static_cast<std::size_t>(beam)];
    CHECK((bent - expected).norm() < 1e-8 * push.norm());  // conditioning of one node's stiffness, 1e4
  }
}

TEST_CASE("A motion is carried over to the modes after a break as far as its nodes go") {
  const FrameModel model = two_storeys();
  const int at = first_loose_node(model);
  const std::array<int, 1> nodes{at};
  FrameDynamics frame(model, {}, undamped());
  const LocalModes before = frame.local_modes(nodes, {});
  const Eigen::VectorXd coordinates = Eigen::VectorXd::LinSpaced(before.squared.size(), 1, 2);
  CHECK((carried_over(before, coordinates, before) - coordinates).norm() < 1e-10 * coordinates.norm());
  int beam = -1;
  for (int b = 0; b < static_cast<int>(model.beams.size()) && beam < 0; ++b)
    if (model.beams[static_cast<std::size_t>(b)].node[0] == at) beam = b;
  REQUIRE(beam >= 0);
  frame.set_end_stiffness(beam, 0, Vec6::Zero());
  frame.strike({});
  const LocalModes after = frame.local_modes(nodes, {});
  const Eigen::VectorXd moved = carried_over(before, coordinates, after);
  CHECK((after.shape * moved - before.shape * coordinates).norm() < 1e-9 * (before.shape * coordinates).norm());
}
