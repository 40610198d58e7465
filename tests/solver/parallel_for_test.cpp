// The loop on several threads: every turn once, the first failure told, threads side by side.
#include "topple/solver/parallel_for.h"

#include <atomic>
#include <catch2/catch.hpp>
#include <stdexcept>
#include <string>
#include <vector>

namespace topple::solver {

TEST_CASE("a loop on threads makes every turn once, whatever the number of threads") {
  for (const int threads : {-1, 0, 1, 2, 7, 64}) {
    std::vector<int> made(50, 0);
    parallel_for(made.size(), threads, [&](std::size_t i) { ++made[i]; });
    CHECK(made == std::vector<int>(50, 1));
  }
  parallel_for(0, 4, [](int) { FAIL("there is no turn to make"); });
}

TEST_CASE("a loop on threads throws what the first turn that failed threw, when all have ended") {
  std::atomic<int> ended{0};
  const auto work = [&](int i) {
    ++ended;
    if (i == 7 || i == 31) throw std::runtime_error(std::to_string(i));
  };
  for (int repeat = 0; repeat < 20; ++repeat) {
    ended = 0;
    std::string told;
    try {
      parallel_for(40, 3, work);
    } catch (const std::runtime_error& error) {
      told = error.what();
    }
    CHECK(told == "7");
    CHECK(ended == 40);
  }
}

TEST_CASE("turns of a loop run at once: two that wait for each other both end") {
  std::atomic<int> here{0};
  parallel_for(2, 2, [&](int) {
    ++here;
    while (here < 2) {
    }
  });
  CHECK(here == 2);
}

}  // namespace topple::solver
