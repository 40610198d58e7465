// Losses of one beam at a time whose answers were found together, against the same without.
#include <catch2/catch.hpp>
#include <random>

#include "frames.h"
#include "topple/solver/reanalysis.h"

using namespace topple::test;

namespace {

Reanalysis loaded_tower() {
  FrameModel model = tower(3, 6);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> size(0.5, 1.5);
  for (Beam& beam : model.beams) beam.Iy *= size(random);
  Reanalysis standing(model);
  for (int i = 0; i < static_cast<int>(model.beams.size()); ++i) {
    const Beam& b = model.beams[static_cast<std::size_t>(i)];
    const Vec3 down = b.axes * Vec3(0, 0, -4000);
    standing.set_beam_loads(i, {uniform_load(i, b.length, components(down.x(), down.y(), down.z(), 0, 0, 0))});
  }
  REQUIRE(standing.solve().stable);
  return standing;
}

double difference(const Reanalysis& a, const Reanalysis& b) {
  double largest = 0, off = 0;
  for (std::size_t n = 0; n < a.displacements().size(); ++n) {
    largest = std::max(largest, a.displacements()[n].cwiseAbs().maxCoeff());
    off = std::max(off, (a.displacements()[n] - b.displacements()[n]).cwiseAbs().maxCoeff());
  }
  return off / largest;
}

}  // namespace

TEST_CASE("losses found together are those found one by one, at less work") {
  Reanalysis together = loaded_tower(), alone = loaded_tower();
  const int beams = static_cast<int>(alone.model().beams.size());
  double work_together = 0, work_alone = 0;
  for (int first = 0; first < beams; first += 16) {
    std::vector<int> batch;
    for (int beam = first; beam < std::min(first + 16, beams); ++beam) batch.push_back(beam);
    together.expect_losses(batch);
    work_together += together.last_operations();
    for (const int beam : batch) {
      for (Reanalysis* one : {&together, &alone}) {
        one->remove_beam(beam);
        const ReanalysisAnswer& answer = one->solve();
        REQUIRE(answer.stable);
        CHECK(answer.quality.backward_error < 1e-13);
        (one == &together ? work_together : work_alone) += one->last_operations();
      }
      INFO("beam " << beam);
      CHECK(difference(together, alone) < 1e-10);  // rounding times the frame's condition
      for (Reanalysis* one : {&together, &alone}) one->restore_beam(beam);
    }
  }
  CHECK(together.counters().refactorisations == 0);
  CHECK(work_together < 0.8 * work_alone);
}

TEST_CASE("what was expected does not hold when something else happens") {
  Reanalysis together = loaded_tower(), alone = loaded_tower();
  const std::vector<int> batch{3, 8, 20, 41};
  together.expect_losses(batch);
  for (Reanalysis* one : {&together, &alone}) {
    one->remove_beam(8);
    one->set_node_load(30, components(0, 2e5, 0, 0, 0, 0));
    one->set_end_stiffness(50, 1, Vec6::Zero());
    REQUIRE(one->solve().stable);
  }
  CHECK(difference(together, alone) < 1e-10);
  for (Reanalysis* one : {&together, &alone}) {
    one->restore_beam(8);
    one->remove_beam(20);
    one->remove_beam(41);
    REQUIRE(one->solve().stable);
  }
  CHECK(difference(together, alone) < 1e-10);
  CHECK(together.solve().quality.backward_error < 1e-13);
}

TEST_CASE("a loss that makes a mechanism is found among those expected") {
  // A post with a beam that hangs at its top: losing the post leaves the beam without hold.
  FrameModel model = tower(2, 2);
  const int last = static_cast<int>(model.nodes.size());
  model.nodes.push_back(model.nodes.back() + Vec3(0, 0, 3));
  Beam post = model.beams.front();
  post.node = {last - 1, last};
  model.beams.push_back(post);
  const int hanging = static_cast<int>(model.beams.size()) - 1;
  Reanalysis standing(model);
  standing.set_node_load(last, components(0, 0, -1e3, 0, 0, 0));
  REQUIRE(standing.solve().stable);
  const std::vector<int> batch{0, hanging, 1};
  standing.expect_losses(batch);
  for (const int beam : batch) {
    standing.remove_beam(beam);
    CHECK(standing.solve().stable == (beam != hanging));
    standing.restore_beam(beam);
  }
  CHECK(standing.solve().stable);
}
