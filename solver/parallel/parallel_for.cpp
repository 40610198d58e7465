#include "topple/solver/parallel_for.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <new>
#include <system_error>
#include <thread>
#include <vector>

namespace topple::solver {

void run_turns(std::size_t count, int threads, const std::function<void(std::size_t)>& work) {
  const std::size_t used = std::min(count, static_cast<std::size_t>(std::max(threads, 1)));
  if (used <= 1) {
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
  {
    std::vector<std::jthread> beside;
    beside.reserve(used - 1);
    try {
      while (beside.size() < used - 1) beside.emplace_back(run);
    } catch (const std::system_error&) {  // no more threads: those that there are do all
    } catch (const std::bad_alloc&) {
    }
    run();
  }
  for (const std::exception_ptr& failure : failures)
    if (failure) std::rethrow_exception(failure);
}

}  // namespace topple::solver
