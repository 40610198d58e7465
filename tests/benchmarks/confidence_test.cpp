// An answer's stated bound against its error, measured against solutions in quadruple precision: an error above the
// bound without a warning is false confidence, and there is none.
#include <catch2/catch.hpp>
#include <cmath>

#include "debris.h"
#include "judge.h"

namespace {

using namespace topple::bench;

void require_honest(const Case& c) {
  for (const Verdict& verdict : judge(c)) {
    CAPTURE(verdict.family, verdict.what, verdict.way, verdict.parameter, verdict.error, verdict.bound,
            verdict.condition);
    CHECK_FALSE(verdict.false_confidence());
  }
}

}  // namespace

TEST_CASE("errors of small frames made by chance stay below their stated bounds") {
  for (unsigned seed = 1; seed <= 1000; ++seed) require_honest(chance_frame(seed));
  // Frames in which the rounding of the assembled matrix weighs most.
  for (const unsigned seed : {3452U, 5601U, 16109U, 17019U}) require_honest(chance_frame(seed));
}

TEST_CASE("structures that less and less holds are answered within the bound, warned of or refused") {
  for (const Case& c : near_mechanisms()) require_honest(c);
}

TEST_CASE("slender, stiff and soft members are answered within the bound, warned of or refused") {
  for (const Case& c : slendernesses()) require_honest(c);
  for (const Case& c : stiffness_ratios()) require_honest(c);
}

TEST_CASE("a frame has the same error and condition in any units") {
  for (const Case& c : unit_systems()) {
    const Verdict verdict = judge(c).front();
    CAPTURE(verdict.what, verdict.error, verdict.condition);
    // 8,800 in the least favourable units; scaling by powers of two leaves a factor of 4 each way.
    CHECK(verdict.condition < 4 * 8.8e3);
    CHECK(verdict.error < 1e-12);  // condition times rounding
    CHECK_FALSE(verdict.false_confidence());
  }
}

TEST_CASE("a reanalysis stays within its bounds through a sequence of damage") {
  for (const Verdict& verdict : judge_damage_sequence(100)) {
    CAPTURE(verdict.parameter, verdict.error, verdict.bound);
    CHECK_FALSE(verdict.false_confidence());
    CHECK(verdict.error < 1e-10);
  }
}

TEST_CASE("a box that does not hold a heavy one is warned of, and one that holds it is not") {
  for (const DebrisVerdict& verdict : judge_debris()) {
    CAPTURE(verdict.side, verdict.mass_ratio, verdict.error, verdict.bound);
    CHECK_FALSE(verdict.false_confidence());
    // Up to ten times the mass nothing may be told; squeezed out is down by the height of a box.
    if (verdict.mass_ratio <= 10) CHECK_FALSE(verdict.warned);
    if (verdict.error > 0.5) CHECK(verdict.warned);
    if (verdict.mass_ratio >= 100) CHECK(verdict.error > 0.5);  // when this changes, so may docs/benchmarks.md
  }
}
