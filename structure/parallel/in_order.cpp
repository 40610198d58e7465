#include "parallel/in_order.h"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>

#include "topple/solver/parallel_for.h"

namespace topple::structure {

int workers_for(std::size_t count, int threads) {
  const std::size_t wanted = threads > 0 ? static_cast<std::size_t>(threads) : std::thread::hardware_concurrency();
  return static_cast<int>(std::clamp<std::size_t>(wanted, 1, std::max<std::size_t>(count, 1)));
}

void in_order(std::size_t count, int threads, const std::function<void(std::size_t, std::string& text)>& make,
              const std::function<void(std::string_view)>& write) {
  std::atomic<std::size_t> next{0};
  std::mutex mutex;
  std::condition_variable changed;
  std::size_t turn = 0;
  std::exception_ptr failure;
  const auto hand_on = [&](std::size_t i, const std::string& text, std::exception_ptr own) {
    std::unique_lock lock(mutex);
    changed.wait(lock, [&] { return turn == i; });
    if (!failure && !own) {
      lock.unlock();  // the others make theirs meanwhile, and wait for this turn to end
      try {
        write(text);
      } catch (...) {
        own = std::current_exception();
      }
      lock.lock();
    }
    if (!failure) failure = own;
    ++turn;
    changed.notify_all();
  };
  const auto run = [&](int /*worker*/) {
    std::string text;
    for (std::size_t i = next++; i < count; i = next++) {
      std::exception_ptr own;
      try {
        make(i, text);
      } catch (...) {
        own = std::current_exception();
      }
      hand_on(i, text, own);
    }
  };
  const int workers = workers_for(count, threads);
  solver::parallel_for(workers, workers, run);
  if (failure) std::rethrow_exception(failure);
}

}  // namespace topple::structure
