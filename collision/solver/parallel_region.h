#pragma once
// The loops of a step, shared with the threads that a host's parallel-for lends. One thread leads: it runs the step,
// and publishes a loop at a time; the others take pieces of it and wait for the next one without sleeping, as a step
// has a thousand loops of some microseconds each. Whoever comes late or never is not waited for: only a piece that was
// taken is. What a piece does may not depend on where pieces begin, so that the bits are those of one thread.
#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <mutex>

#include "topple/collision/world.h"

namespace topple::collision {

class ParallelRegion {
 public:
  ParallelRegion() = default;
  /// `threads` calls of one parallel-for; none, or fewer than two: all loops are the caller's.
  ParallelRegion(ParallelFor parallel_for, int threads);
  ParallelRegion(const ParallelRegion& of) : ParallelRegion(of.parallel_for_, of.threads_) {}
  ParallelRegion& operator=(const ParallelRegion& of);

  [[nodiscard]] bool has_helpers() const { return threads_ > 1; }
  /// Calls work() once, on one of the threads. Its loops are shared; regions do not nest. Throws what work() threw.
  void run(const std::function<void()>& work);
  /// Calls work(begin, end) for pieces that make up 0 ... count, none smaller than `least` but the last. Throws what
  /// one of them threw.
  template <class Work>
  void loop(std::size_t count, std::size_t least, const Work& work) {
    if (!open_ || count <= least) {
      if (count > 0) work(std::size_t{0}, count);
      return;
    }
    share(count, least, &work,
          [](const void* of, std::size_t begin, std::size_t end) { (*static_cast<const Work*>(of))(begin, end); });
  }

  /// The same, turn by turn: calls work(0) ... work(count - 1).
  template <class Work>
  void each(std::size_t count, std::size_t least, const Work& work) {
    loop(count, least, [&work](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) work(i);
    });
  }

 private:
  using Call = void (*)(const void* work, std::size_t begin, std::size_t end);
  void share(std::size_t count, std::size_t least, const void* work, Call call);
  /// Takes and does a piece of the loop that is published, from its front or its back. False when none is left.
  bool claim_piece(bool from_front);
  void help();

  ParallelFor parallel_for_;
  int threads_ = 1;
  bool open_ = false;  ///< to the leader
  // The loop: written by the leader while no piece is taken.
  struct Loop {
    const void* work = nullptr;
    Call call = nullptr;
    std::size_t count = 0, piece = 1;
  } loop_;
  std::uint64_t number_ = 0;                         ///< of the loop
  alignas(64) std::atomic<std::uint64_t> state_{0};  ///< its number, its pieces, those taken from front and back
  alignas(64) std::atomic<std::uint32_t> done_{0};   ///< pieces
  alignas(64) std::atomic<bool> led_{false};
  std::atomic<bool> closed_{false};
  std::mutex failing_;
  std::exception_ptr failure_;
};

}  // namespace topple::collision
