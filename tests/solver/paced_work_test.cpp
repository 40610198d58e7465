// Work at a pace: where it stops, what it costs, and that stopping changes nothing.
#include "topple/solver/paced_work.h"

#include <catch2/catch.hpp>
#include <stdexcept>
#include <utility>
#include <vector>

#include "frames.h"
#include "topple/solver/reanalysis.h"

using namespace topple::test;
using topple::solver::PacedWork;
using topple::solver::spend;
using topple::solver::spent_here;

namespace {

/// Grants one after the other until it is done; returns their number.
int grants_until_done(PacedWork& work, double each) {
  int count = 0;
  while (!work.done()) {
    (void)work.go_on(each);
    REQUIRE(++count < 1000000);
  }
  return count;
}

}  // namespace

TEST_CASE("paced work stops where its grant ends and goes on from there") {
  PacedWork work;
  std::vector<int> done;
  work.begin([&] {
    for (int i = 0; i < 4; ++i) {
      spend(10);
      done.push_back(i);
    }
  });
  CHECK_FALSE(work.done());
  CHECK(done.empty());  // it begins with the first grant
  CHECK(work.go_on(25) == 0);
  CHECK(done == std::vector<int>{0, 1});
  CHECK(work.go_on(4) == 0);  // 29 of the 30 that the third takes
  CHECK(done == std::vector<int>{0, 1});
  CHECK(work.go_on(1) == 0);
  CHECK(done == std::vector<int>{0, 1, 2});
  CHECK(work.go_on(17) == 7);
  CHECK(work.done());
  CHECK(done == std::vector<int>{0, 1, 2, 3});
}

TEST_CASE("work is done with the same grant whether it stopped on the way, was run out, or could not stop") {
  const auto steps = [](int pieces, bool look) {
    PacedWork work;
    work.begin([&] {
      for (int i = 0; i < pieces; ++i) spend(100.0 / pieces);
    });
    int grants = 0;
    double left = 0;
    while (!work.done()) {
      left = work.go_on(7);
      ++grants;
      if (look && grants == 3) work.run_out();
    }
    return std::pair(grants, left);
  };
  const auto expected = std::pair(15, 5.0);
  CHECK(steps(50, false) == expected);
  CHECK(steps(1, false) == expected);
  CHECK(steps(50, true) == expected);
  CHECK(steps(2, true) == expected);
}

TEST_CASE("work that is finished at once says what it owes") {
  PacedWork work;
  int pieces = 0;
  work.begin([&] {
    for (; pieces < 5; ++pieces) spend(10);
  });
  (void)work.go_on(15);
  CHECK(work.finish() == 35);
  CHECK(pieces == 5);
  CHECK(work.done());
  CHECK(work.finish() == 0);
}

TEST_CASE("what work throws comes out of the grant that ends it, and the next work is sound") {
  PacedWork work;
  work.begin([] {
    spend(10);
    throw std::runtime_error("no");
  });
  CHECK(work.go_on(5) == 0);
  CHECK_THROWS_WITH(work.go_on(100), "no");
  CHECK(work.done());
  bool ran = false;
  work.begin([&] { ran = true; });
  CHECK(work.go_on(1) == 1);
  CHECK(ran);
}

TEST_CASE("what is spent outside of paced work is counted for its thread") {
  const double before = spent_here();
  spend(12);
  PacedWork work;
  work.begin([] { spend(1000); });
  CHECK(grants_until_done(work, 100) == 10);
  CHECK(spent_here() - before == 12);
}

TEST_CASE("work under way ends with its owner") {
  bool ended = false;
  {
    PacedWork work;
    work.begin([&] {
      for (int i = 0; i < 3; ++i) spend(10);
      ended = true;
    });
    (void)work.go_on(15);
    CHECK_FALSE(ended);
  }
  CHECK(ended);
}

TEST_CASE("an answer at a pace has the bits and the price of one at once, on one thread and on two") {
  const FrameModel model = tower(9, 16);
  struct Run {
    std::vector<Vec6> displacements;
    int grants = 0;
  };
  const auto run = [&](double grant, int threads) {
    AnalysisOptions options;
    options.threads = threads;
    Reanalysis standing(model, options);
    for (int node = 81; node < 162; ++node) standing.set_node_load(node, unit(node % 3, 5000 + node));
    Run result;
    PacedWork work;
    const auto solve = [&] {
      work.begin([&] { REQUIRE(standing.solve().stable); });
      result.grants += grants_until_done(work, grant);
    };
    solve();  // a factorisation
    for (int beam = 3; beam < 12; beam += 4) {
      standing.set_end_stiffness(beam, 1, Vec6::Zero());
      solve();  // corrections
    }
    result.displacements = standing.displacements();
    return result;
  };
  const Run whole = run(1e18, 1), parts = run(1e6, 1), beside = run(1e6, 2);
  CHECK(whole.grants == 4);
  CHECK(parts.grants > 400);
  CHECK(beside.grants == parts.grants);
  CHECK(parts.displacements == whole.displacements);
  CHECK(beside.displacements == whole.displacements);
}
