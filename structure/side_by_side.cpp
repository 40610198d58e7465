#include "side_by_side.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <thread>
#include <vector>

namespace topple::structure {

std::size_t workers_for(std::size_t count, int threads) {
  const std::size_t wanted = threads > 0 ? static_cast<std::size_t>(threads) : std::thread::hardware_concurrency();
  return std::clamp<std::size_t>(wanted, 1, std::max<std::size_t>(count, 1));
}

void side_by_side(std::size_t count, int threads, const std::function<void(std::size_t)>& work) {
  const std::size_t workers = workers_for(count, threads);
  if (workers == 1) {
    for (std::size_t i = 0; i < count; ++i) work(i);
    return;
  }
  std::atomic<std::size_t> next{0};
  std::vector<std::exception_ptr> failures(count);
  const auto run = [&] {
    for (std::size_t i = next++; i < count; i = next++) {
      try {
        work(i);
      } catch (...) {
        failures[i] = std::current_exception();
      }
    }
  };
  std::vector<std::thread> threads_beside;
  for (std::size_t t = 1; t < workers; ++t) threads_beside.emplace_back(run);
  run();
  for (std::thread& thread : threads_beside) thread.join();
  for (const std::exception_ptr& failure : failures)
    if (failure) std::rethrow_exception(failure);
}

}  // namespace topple::structure
