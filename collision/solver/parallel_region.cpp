#include "solver/parallel_region.h"

#include <thread>
#include <utility>

#ifdef __x86_64__
#include <immintrin.h>
#endif

namespace topple::collision {

namespace {

// Of a loop's state: pieces, those taken from the front, those from the back, 13 bits each; its number above.
constexpr int bits = 13;
constexpr std::uint64_t most_pieces = 1 << 12, mask = (1 << bits) - 1;
constexpr std::uint64_t front_one = std::uint64_t{1} << bits, back_one = std::uint64_t{1} << (2 * bits);

/// A wait of microseconds: the processor's pause, and now and then the system's, where threads are more than
/// processors.
class Wait {
 public:
  void once() {
    if (++count_ % 1024 == 0) {
      std::this_thread::yield();
      return;
    }
#ifdef __x86_64__
    _mm_pause();
#endif
  }

 private:
  unsigned count_ = 0;
};

}  // namespace

ParallelRegion::ParallelRegion(ParallelFor parallel_for, int threads)
    : parallel_for_(std::move(parallel_for)), threads_(parallel_for_ ? std::max(1, threads) : 1) {}

ParallelRegion& ParallelRegion::operator=(const ParallelRegion& of) {
  parallel_for_ = of.parallel_for_;
  threads_ = of.threads_;
  return *this;
}

void ParallelRegion::run(const std::function<void()>& work) {
  if (!has_helpers()) {
    work();
    return;
  }
  led_ = closed_ = false;
  std::exception_ptr thrown;
  parallel_for_(static_cast<std::size_t>(threads_), [&](std::size_t) {
    if (led_.exchange(true)) {
      help();
      return;
    }
    open_ = true;
    try {
      work();
    } catch (...) {
      thrown = std::current_exception();
    }
    open_ = false;
    closed_.store(true, std::memory_order_release);
  });
  if (thrown) std::rethrow_exception(thrown);
}

void ParallelRegion::help() {
  Wait wait;
  while (!closed_.load(std::memory_order_acquire))
    if (!claim_piece(false)) wait.once();
}

bool ParallelRegion::claim_piece(bool from_front) {
  std::uint64_t state = state_.load(std::memory_order_acquire);
  std::uint64_t pieces, front, back;
  do {
    pieces = state & mask;
    front = state >> bits & mask;
    back = state >> (2 * bits) & mask;
    if (front + back >= pieces) return false;
  } while (!state_.compare_exchange_weak(state, state + (from_front ? front_one : back_one), std::memory_order_acq_rel,
                                         std::memory_order_acquire));
  const std::size_t begin = (from_front ? front : pieces - 1 - back) * loop_.piece;
  try {
    loop_.call(loop_.work, begin, std::min(loop_.count, begin + loop_.piece));
  } catch (...) {
    const std::scoped_lock lock(failing_);
    failure_ = std::current_exception();
  }
  done_.fetch_add(1, std::memory_order_release);
  return true;
}

void ParallelRegion::share(std::size_t count, std::size_t least, const void* work, Call call) {
  constexpr std::size_t for_each_thread = 4;  // who is slower takes fewer
  const std::size_t wanted = std::min<std::size_t>(most_pieces, for_each_thread * static_cast<std::size_t>(threads_));
  loop_ = {work, call, count, std::max(least, (count + wanted - 1) / wanted)};
  const std::size_t pieces = (count + loop_.piece - 1) / loop_.piece;
  done_.store(0, std::memory_order_relaxed);
  state_.store(++number_ << (3 * bits) | pieces, std::memory_order_release);
  while (claim_piece(true)) {
  }
  Wait wait;
  while (done_.load(std::memory_order_acquire) < pieces) wait.once();
  if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
}

}  // namespace topple::collision
