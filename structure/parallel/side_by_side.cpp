#include "parallel/side_by_side.h"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "parallel/threads_beside.h"

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
  {
    const ThreadsBeside beside(workers - 1, run);
    run();
  }
  for (const std::exception_ptr& failure : failures)
    if (failure) std::rethrow_exception(failure);
}

void in_order(std::size_t count, int threads, const std::function<void(std::size_t, std::string& text)>& make,
              const std::function<void(std::string_view)>& take) {
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
        take(text);
      } catch (...) {
        own = std::current_exception();
      }
      lock.lock();
    }
    if (!failure) failure = own;
    ++turn;
    changed.notify_all();
  };
  const auto run = [&] {
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
  {
    const ThreadsBeside beside(workers_for(count, threads) - 1, run);
    run();
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace topple::structure
