// Random sequences of changes on random frames: whatever strategy is chosen, the answer is that of a fresh analysis
// of the changed model, and what is a mechanism there is one here.
#include <catch2/catch.hpp>

#include "changing_frame.h"

using namespace topple::test;

TEST_CASE("random changes give the answers of fresh analyses, and no mechanism is missed or invented") {
  ChangeTally tally;
  for (unsigned seed = 1; seed <= 12; ++seed) {
    ChangingFrame frame(2 + static_cast<int>(seed % 3), 3 + static_cast<int>(seed % 4), seed, seed % 2 == 0);
    INFO("seed " << seed);
    CHECK(follow(frame, 60, tally) == "");
  }
  CHECK(tally.answers == 12 * 60);
  CHECK(tally.mechanisms > 10);
  CHECK(tally.splits > 5);
  CHECK(tally.work.low_rank > 300);
  CHECK(tally.work.refactorisations > 12);
}

TEST_CASE("breaking and restoring a joint returns to the very same answer") {
  ChangingFrame frame(3, 5, 7);
  REQUIRE(frame.standing->solve().stable);
  const std::vector<Vec6> before = frame.standing->displacements();
  frame.standing->set_end_stiffness(17, 0, Vec6::Zero());
  REQUIRE(frame.standing->solve().stable);
  const std::vector<Vec6> broken = frame.standing->displacements();
  frame.standing->set_end_stiffness(17, 0, fixed());
  REQUIRE(frame.standing->solve().stable);
  double moved = 0;
  for (std::size_t n = 0; n < before.size(); ++n) {
    CHECK(before[n] == frame.standing->displacements()[n]);
    moved = std::max(moved, (before[n] - broken[n]).norm());
  }
  CHECK(moved > 1e-6);
  CHECK(frame.standing->counters().refactorisations == 0);
  CHECK(frame.standing->counters().low_rank == 2);
}

TEST_CASE("joints broken and restored many times over cost no more, and are not forgotten") {
  ChangingFrame frame(3, 4, 5);
  REQUIRE(frame.standing->solve().stable);
  const int beams = static_cast<int>(frame.standing->model().beams.size());
  ChangeTally tally;
  for (int round = 0; round < 3; ++round) {
    for (int beam = 0; beam < beams; ++beam) {
      frame.set_end(beam, 1, Vec6::Zero());
      CHECK(settle_and_compare(frame, tally).empty());
      frame.set_end(beam, 1, fixed());
      CHECK(settle_and_compare(frame, tally).empty());
      // Broken again at once, and then another one before the first is restored.
      frame.set_end(beam, 1, Vec6::Zero());
      CHECK(settle_and_compare(frame, tally).empty());
      frame.set_end((beam + 7) % beams, 1, Vec6::Zero());
      CHECK(settle_and_compare(frame, tally).empty());
      frame.set_end(beam, 1, fixed());
      frame.set_end((beam + 7) % beams, 1, fixed());
    }
  }
  CHECK(tally.answers == 3 * 4 * beams);
  CHECK(frame.standing->counters().refactorisations == 0);
}

TEST_CASE("few broken joints are corrected, many are factorised anew") {
  ChangingFrame frame(4, 8, 3);
  REQUIRE(frame.standing->solve().stable);
  frame.standing->set_end_stiffness(100, 0, Vec6::Zero());
  REQUIRE(frame.standing->solve().stable);
  CHECK(frame.standing->counters().refactorisations == 0);
  // Every third beam a tenth softer: nothing falls, and far too many columns for a correction.
  for (int beam = 0; beam < static_cast<int>(frame.standing->model().beams.size()); beam += 3)
    frame.standing->set_beam_stiffness_factor(beam, 0.9);
  REQUIRE(frame.standing->solve().stable);
  CHECK(frame.standing->counters().refactorisations == 1);
}
