// How a frame that moves will take its next substep, told before it: what moves with the frame couples to that.
#include <catch2/catch.hpp>

#include "frames.h"
#include "topple/solver/frame_dynamics.h"

using namespace topple::test;

namespace {

struct Swaying {
  FrameModel model = tower(4, 3);
  DynamicOptions options;

  Swaying() {
    for (Beam& beam : model.beams) beam.density = 7850;
    options.substep = 1.0 / 480;
    options.spectral_radius = 0.8;
    options.damping = {0.3, 2e-4};
  }
  [[nodiscard]] FrameDynamics frame() const {
    FrameDynamics made(model, {}, options);
    made.set_node_load(17, components(1000, 2000, -5000, 30, 0, 50));
    return made;
  }
};

Vec6 velocity(const FrameDynamics& frame, int node) { return frame.velocities()[static_cast<std::size_t>(node)]; }

}  // namespace

TEST_CASE("What a frame foresees of its next substep is what comes while its loads go on") {
  Swaying swaying;
  swaying.options.second_order = GENERATE(false, true);
  FrameDynamics frame = swaying.frame();
  for (int n = 0; n < 20; ++n) {
    if (n == 5) frame.set_node_load(21, components(0, -3000, 2000, 0, 40, 0));
    if (n == 8) frame.set_end_stiffness(20, 0, Vec6::Zero());
    if (n == 11) frame.set_beam_density(8, 2 * 7850);
    if (n == 14) frame.strike(std::vector<FrameDynamics::Impulse>{{22, components(30, 0, 0, 0, 0, 1)}});
    if (n == 17) frame.add_impulses(std::vector<FrameDynamics::Impulse>{{22, components(0, 20, 0, 0, 0, 0)}});
    const std::vector<Vec6> foreseen = frame.foresee();
    const std::vector<Vec6> before = frame.velocities();
    frame.advance();
    const std::vector<Vec6>& after = frame.velocities();
    double size = 0, off = 0;
    for (std::size_t i = 0; i < before.size(); ++i) {
      const Vec6 mean = (after[i] - before[i]) / frame.substep();
      size = std::max(size, mean.norm());
      off = std::max(off, (mean - foreseen[i]).norm());
    }
    REQUIRE(size > 0);
    // First order: the same arithmetic but for rounding. Second order: geometric forces go on as they are.
    CHECK(off < (swaying.options.second_order ? 1e-3 : 1e-9) * size);
  }
}

TEST_CASE("To foresee a substep changes nothing of it") {
  const Swaying swaying;
  FrameDynamics asked = swaying.frame(), other = swaying.frame();
  for (int n = 0; n < 10; ++n) {
    (void)asked.foresee();
    asked.advance();
    other.advance();
    REQUIRE(asked.displacements() == other.displacements());
    REQUIRE(asked.energy().elastic == other.energy().elastic);
  }
}

TEST_CASE("A force through a substep moves its place by the mobility of the substep") {
  const Swaying swaying;
  const int node = 21;
  for (const bool broken : {false, true}) {
    FrameDynamics frame = swaying.frame();
    std::vector<std::vector<FrameDynamics::Impulse>> units;
    for (int c = 0; c < 6; ++c) units.push_back({{node, Vec6::Unit(c)}});
    if (broken) frame.set_end_stiffness(30, 1, components(1e7, 1e7, 1e7, 1e4, 1e4, 1e4));
    for (int n = 0; n < 5; ++n) frame.advance();
    const Eigen::MatrixXd mobility = frame.substep_mobility(units);
    Eigen::MatrixXd moved(6, 6);
    const auto after = [&](int c) {
      FrameDynamics other = swaying.frame();
      if (broken) other.set_end_stiffness(30, 1, components(1e7, 1e7, 1e7, 1e4, 1e4, 1e4));
      for (int n = 0; n < 5; ++n) other.advance();
      if (c >= 0) other.set_node_load(node, 1000 * Vec6::Unit(c));
      other.advance();
      return velocity(other, node);
    };
    const Vec6 without = after(-1);
    for (int c = 0; c < 6; ++c) moved.col(c) = (after(c) - without) / frame.substep() / 1000;
    CHECK((mobility - moved).norm() < 1e-8 * moved.norm());
    // Stiffness resists meanwhile, as it does not at the first moment.
    CHECK((mobility.diagonal().array() < frame.mobility(units).diagonal().array()).all());
  }
}
