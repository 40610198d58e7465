// A beam whose ends break one after the other: on a pin it is a mechanism, which is no part of the frame any more.
#include <algorithm>
#include <catch2/catch.hpp>

#include "frames.h"
#include "topple/solver/frame_dynamics.h"

using namespace topple::test;

namespace {

class MomentLimit : public JointLaw {
 public:
  explicit MomentLimit(double capacity) : capacity_(capacity) {}
  [[nodiscard]] double beam_utilisation(int beam, const Vec12& forces) const override {
    return end_utilisation(beam, 1, forces);
  }
  [[nodiscard]] double end_utilisation(int beam, int end, const Vec12& forces) const override {
    return beam == 2 && end == 1 ? forces.tail<3>().norm() / capacity_ : 0;
  }

 private:
  double capacity_;
};

/// Its first end breaks as soon as it is let, by whatever force.
class LetGo : public JointLaw {
 public:
  bool now = false;
  [[nodiscard]] double beam_utilisation(int beam, const Vec12& forces) const override {
    return std::max(end_utilisation(beam, 0, forces), end_utilisation(beam, 1, forces));
  }
  [[nodiscard]] double end_utilisation(int beam, int end, const Vec12& forces) const override {
    if (beam != 2) return 0;
    if (end == 1) return forces.tail<3>().norm() / 2000;
    return now ? 2 : 0;
  }
};

/// Two posts on the ground, and a beam on them.
FrameModel portal() {
  FrameModel model;
  model.nodes = {Vec3(0, 0, 0), Vec3(0, 0, 3), Vec3(5, 0, 0), Vec3(5, 0, 3)};
  model.supports = {{0, fixed()}, {2, fixed()}};
  add_beam(model, 0, 1);
  add_beam(model, 2, 3);
  add_beam(model, 1, 3);
  for (Beam& beam : model.beams) beam.density = 7850;
  return model;
}

}  // namespace

TEST_CASE("A beam on a pin leaves as its other end breaks, and the posts beside it go on") {
  FrameModel model = portal();
  model.beams[2].end_stiffness[0] = components(rigid, rigid, rigid, rigid, 0, 0);
  DynamicOptions options;
  options.substep = 1e-3;
  options.spectral_radius = 1;
  FrameDynamics frame(model, MassModel(), options);
  frame.set_node_load(3, unit(4, 6000));
  const MomentLimit law(2000);
  std::vector<JointBreak> breaks;
  Vec6 left = Vec6::Zero();
  for (int n = 0; n < 400; ++n) {
    const std::vector<JointBreak> now = frame.advance(&law);
    if (!now.empty()) left = frame.beam_momentum(2);
    breaks.insert(breaks.end(), now.begin(), now.end());
  }
  REQUIRE(breaks.size() == 1);
  CHECK(breaks[0].beam == 2);
  CHECK(breaks[0].end == 1);
  CHECK(left.head<3>().norm() > 0);  // it took its motion along
  CHECK(frame.model().beams[2].end_stiffness[0].isZero(0));
  // Rounding, of the work that the load has done.
  const DynamicEnergy e = frame.energy();
  INFO("kinetic " << e.kinetic << ", elastic " << e.elastic << ", numerical " << e.numerical << ", freed " << e.freed
                  << ", work " << e.external_work);
  CHECK(std::abs(e.kinetic + e.elastic + e.damped + e.numerical + e.freed - e.external_work) < 1e-9 * e.external_work);
  // Nothing more is lost by the posts alone.
  for (int n = 0; n < 1000; ++n) frame.advance(&law);
  CHECK(frame.energy().freed == e.freed);
}

TEST_CASE(
    "A beam that hangs on from one joint leaves by the force of that joint, not by that of the one which broke "
    "before") {
  const FrameModel model = portal();
  DynamicOptions options;
  options.substep = 1e-3;
  FrameDynamics frame(model, MassModel(), options);
  frame.set_node_load(3, unit(4, 6000));
  LetGo law;
  double broke_with = 0;
  for (int n = 0; n < 2000; ++n)
    for (const JointBreak& one : frame.advance(&law)) broke_with = one.forces.segment<3>(6).norm();
  REQUIRE(broke_with > 0);
  const Vec3 before = frame.beam_momentum(2).head<3>();
  const double held = frame.beam_end_forces(2).head<3>().norm();
  law.now = true;
  const std::vector<JointBreak> last = frame.advance(&law);
  REQUIRE(last.size() == 1);
  CHECK(last[0].end == 0);
  const Vec3 after = frame.beam_momentum(2).head<3>();
  CHECK(broke_with > 20 * held);  // or what was handed over then would not be seen
  CHECK((after - before).norm() <= options.substep * (2 * held + 1e-9 * broke_with));  // rounding
}
