#include "parallel/each_on_threads.h"

#include <algorithm>
#include <exception>
#include <system_error>
#include <thread>
#include <vector>

namespace topple::solver {

void each_on_threads(int count, int threads, const std::function<void(int)>& work) {
  const int used = std::clamp(threads, 1, std::max(count, 1));
  std::vector<std::exception_ptr> failures(static_cast<std::size_t>(used));
  const auto share = [&](int t) {
    try {
      for (int i = t * count / used; i < (t + 1) * count / used; ++i) work(i);
    } catch (...) {
      failures[static_cast<std::size_t>(t)] = std::current_exception();
    }
  };
  {
    std::vector<std::jthread> beside;
    beside.reserve(static_cast<std::size_t>(used - 1));
    try {
      for (int t = 1; t < used; ++t) beside.emplace_back(share, t);
    } catch (const std::system_error&) {
      // The system gives no more threads: what is left is done here.
    }
    share(0);
    for (int t = static_cast<int>(beside.size()) + 1; t < used; ++t) share(t);
  }
  for (const std::exception_ptr& failure : failures)
    if (failure) std::rethrow_exception(failure);
}

}  // namespace topple::solver
