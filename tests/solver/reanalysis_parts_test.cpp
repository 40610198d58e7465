// An answer found in two parts, the factor first.
#include <catch2/catch.hpp>

#include "frames.h"
#include "topple/solver/reanalysis.h"

using namespace topple::test;

namespace {

Reanalysis loaded(const FrameModel& model) {
  Reanalysis standing(model);
  for (int node = 16; node < 32; ++node) standing.set_node_load(node, unit(node % 3, 5000 + node));
  REQUIRE(standing.solve().stable);
  return standing;
}

void check_same(const Reanalysis& a, const Reanalysis& b) {
  REQUIRE(a.displacements().size() == b.displacements().size());
  for (std::size_t n = 0; n < a.displacements().size(); ++n) CHECK(a.displacements()[n] == b.displacements()[n]);
}

}  // namespace

TEST_CASE("an answer in two parts has the bits of one, and until the second the last answer holds") {
  const FrameModel model = tower(3, 4);
  Reanalysis parts = loaded(model), whole = loaded(model);
  for (int beam = 3; beam < 12; beam += 4) {
    const std::vector<Vec6> last = parts.displacements();
    for (Reanalysis* one : {&parts, &whole}) one->set_end_stiffness(beam, 1, Vec6::Zero());
    REQUIRE(parts.prepare());
    CHECK(parts.last_operations() > 0);
    CHECK(parts.displacements() == last);
    REQUIRE(parts.prepare());  // there is nothing more to do
    CHECK(parts.last_operations() == 0);
    REQUIRE(parts.solve().stable);
    REQUIRE(whole.solve().stable);
    check_same(parts, whole);
  }
  CHECK(parts.counters().solves == whole.counters().solves);
}

TEST_CASE("changes that come between the two parts of an answer are in it") {
  const FrameModel model = tower(3, 4);
  Reanalysis parts = loaded(model), fresh = loaded(model);
  parts.set_end_stiffness(5, 0, Vec6::Zero());
  REQUIRE(parts.prepare());
  parts.set_node_load(20, unit(0, 9000));
  parts.set_end_stiffness(9, 0, Vec6::Zero());
  REQUIRE(parts.solve().stable);
  fresh.set_end_stiffness(5, 0, Vec6::Zero());
  fresh.set_end_stiffness(9, 0, Vec6::Zero());
  fresh.set_node_load(20, unit(0, 9000));
  REQUIRE(fresh.solve().stable);
  double largest = 0, difference = 0;
  for (std::size_t n = 0; n < fresh.displacements().size(); ++n) {
    largest = std::max(largest, fresh.displacements()[n].norm());
    difference = std::max(difference, (fresh.displacements()[n] - parts.displacements()[n]).norm());
  }
  CHECK(difference < 1e-10 * largest);  // rounding times the condition of a small frame, 1e5
}

TEST_CASE("a mechanism is known after the first part") {
  FrameModel model = tower(1, 1);
  Reanalysis standing(model);
  standing.set_node_load(static_cast<int>(model.nodes.size()) - 1, unit(0, 100));
  REQUIRE(standing.solve().stable);
  for (int beam = 0; beam < static_cast<int>(model.beams.size()); ++beam)
    standing.set_end_stiffness(beam, 0, Vec6::Zero());
  CHECK_FALSE(standing.prepare());
  CHECK_FALSE(standing.solve().stable);
}
