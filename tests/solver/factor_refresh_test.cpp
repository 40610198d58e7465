// Factors made on another thread while the old one serves: when they take over is fixed beforehand, and what they
// answer is right.
#include <atomic>
#include <catch2/catch.hpp>
#include <chrono>
#include <thread>

#include "changing_frame.h"

using namespace topple::test;

namespace {

/// Begun with the third changed member, and small frames too.
RefreshRules soon() {
  RefreshRules rules;
  rules.columns = 12;
  rules.least_operations = 0;
  rules.share = 0.5;
  return rules;
}

struct Run {
  std::vector<std::vector<Vec6>> answers;
  ReanalysisCounters counters;
  std::string fault;
};

Run run(unsigned seed, const RefreshRules& rules) {
  ChangingFrame frame(4, 6, seed);
  frame.standing->set_refresh(rules);
  Run result;
  ChangeTally tally;
  for (int i = 0; i < 60 && result.fault.empty(); ++i) {
    frame.change();
    result.fault = settle_and_compare(frame, tally);
    result.answers.push_back(frame.standing->displacements());
  }
  result.counters = frame.standing->counters();
  return result;
}

}  // namespace

TEST_CASE("answers over a factor made in the background are those of fresh analyses") {
  std::uint64_t background = 0;
  for (unsigned seed = 1; seed <= 6; ++seed) {
    const Run one = run(seed, soon());
    INFO("seed " << seed);
    CHECK(one.fault.empty());
    background += one.counters.background_factors;
  }
  CHECK(background >= 12);
}

TEST_CASE("a slow worker changes no bit: the answer that needs its factor waits, and that is counted") {
  for (unsigned seed = 1; seed <= 3; ++seed) {
    const Run fast = run(seed, soon());
    RefreshRules slowed = soon();
    std::atomic<int> begun{0};
    slowed.on_worker = [&] {
      ++begun;
      std::this_thread::sleep_for(std::chrono::milliseconds(150));
    };
    const Run slow = run(seed, slowed);
    INFO("seed " << seed);
    CHECK(slow.fault.empty());
    CHECK(slow.counters.background_factors > 0);
    CHECK(slow.counters.background_factors == fast.counters.background_factors);
    CHECK(slow.counters.late_factors > 0);
    CHECK(static_cast<std::uint64_t>(begun) >= slow.counters.background_factors);
    REQUIRE(slow.answers.size() == fast.answers.size());
    for (std::size_t i = 0; i < fast.answers.size(); ++i) CHECK(slow.answers[i] == fast.answers[i]);
  }
}

TEST_CASE("a frame that ends while its new factor is made waits for the thread") {
  RefreshRules rules = soon();
  rules.share = 1e9;  // never due
  std::atomic<bool> ended{false};
  rules.on_worker = [&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    ended = true;
  };
  {
    ChangingFrame frame(4, 6, 3);
    frame.standing->set_refresh(rules);
    for (int beam = 0; beam < 40; beam += 10) {
      frame.soften(beam, 0.5);
      REQUIRE(frame.standing->solve().stable);
    }
    CHECK(frame.standing->counters().background_factors == 0);
  }
  CHECK(ended);
}
