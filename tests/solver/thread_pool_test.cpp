// Threads that are kept for loops one soon after another.
#include "topple/solver/thread_pool.h"

#include <atomic>
#include <catch2/catch.hpp>
#include <chrono>
#include <thread>
#include <vector>

namespace topple::solver {

TEST_CASE("a pool of threads makes every turn of every loop once") {
  for (const int threads : {-1, 1, 2, 7}) {
    ThreadPool pool(threads);
    CHECK(pool.threads() >= 1);
    CHECK(pool.threads() <= std::max(threads, 1));
    std::vector<std::atomic<int>> made(13);
    for (int repeat = 0; repeat < 2000; ++repeat) pool.run(made.size(), [&](std::size_t i) { ++made[i]; });
    for (const auto& times : made) CHECK(times == 2000);
    pool.run(0, [](std::size_t) { FAIL("there is no turn to make"); });
  }
}

TEST_CASE("turns of a pool's loop run side by side, also after its threads have gone to sleep") {
  ThreadPool pool(2);
  if (pool.threads() < 2) return;  // the system gives no thread
  for (int repeat = 0; repeat < 5; ++repeat) {
    std::atomic<int> there{0};
    pool.run(2, [&](std::size_t) {
      ++there;
      while (there < 2) std::this_thread::yield();  // for ever, were it one after another
    });
    CHECK(there == 2);
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
}

TEST_CASE("who comes to a pool while another's loop runs makes its turns by itself") {
  ThreadPool pool(2);
  std::atomic<int> inner{0};
  pool.run(4, [&](std::size_t) { pool.run(3, [&](std::size_t) { ++inner; }); });
  CHECK(inner == 12);
}

}  // namespace topple::solver
