#include "topple/solver/thread_pool.h"

#include <new>
#include <system_error>

namespace topple::solver {

namespace {
/// Looks at the time between two loops before a thread sleeps: some 50 microseconds.
constexpr int looks = 100000;
}  // namespace

ThreadPool::ThreadPool(int threads) {
  try {
    while (static_cast<int>(beside_.size()) + 1 < threads) beside_.emplace_back([this] { wait_for_loops(); });
  } catch (const std::system_error&) {  // no more threads: those that there are do all
  } catch (const std::bad_alloc&) {
  }
}

ThreadPool::~ThreadPool() {
  ended_ = true;
  ++loops_;
  loops_.notify_all();
}

void ThreadPool::wait_for_loops() {
  for (std::uint32_t seen = 0; !ended_;) {
    for (int i = 0; i < looks && loops_.load(std::memory_order_relaxed) == seen; ++i) {
    }
    loops_.wait(seen);
    seen = loops_;
    run_loop_turns();
  }
}

void ThreadPool::run_loop_turns() {
  for (;;) {
    const std::function<void(std::size_t)>* work = nullptr;
    std::size_t turn = 0;
    {
      const std::scoped_lock lock(turns_);
      if (!work_ || next_ == count_) return;
      work = work_;
      turn = next_++;
      ++running_;
    }
    (*work)(turn);
    running_.fetch_sub(1, std::memory_order_release);
  }
}

void ThreadPool::run(std::size_t count, const std::function<void(std::size_t)>& work) {
  if (busy_.test_and_set(std::memory_order_acquire)) {
    for (std::size_t i = 0; i < count; ++i) work(i);
    return;
  }
  {
    const std::scoped_lock lock(turns_);
    work_ = &work;
    next_ = 0;
    count_ = count;
  }
  if (count > 1) {
    ++loops_;
    loops_.notify_all();
  }
  run_loop_turns();
  {
    const std::scoped_lock lock(turns_);
    work_ = nullptr;
  }
  while (running_.load(std::memory_order_acquire) > 0) std::this_thread::yield();
  busy_.clear(std::memory_order_release);
}

}  // namespace topple::solver
