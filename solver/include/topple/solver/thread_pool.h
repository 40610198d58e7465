#pragma once
// Threads that are kept for loops which come one soon after another, each shorter than a thread takes to start.
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace topple::solver {

/// A loop's turns, on threads that are there already.
class ThreadPool {
 public:
  /// `threads`, the caller's among them: one less is started, or as many as the system gives.
  explicit ThreadPool(int threads);
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;
  ~ThreadPool();

  /// How many there are, the caller's among them.
  [[nodiscard]] int threads() const { return static_cast<int>(beside_.size()) + 1; }
  /// Calls work(0) ... work(count - 1), in any order, on the threads that are free, and returns when all have ended:
  /// a thread that is late is not waited for. Turns may not throw. A caller that comes while another's loop runs makes
  /// its turns by itself.
  void run(std::size_t count, const std::function<void(std::size_t)>& work);

 private:
  void wait_for_loops();
  void run_loop_turns();

  std::atomic_flag busy_;
  std::mutex turns_;
  const std::function<void(std::size_t)>* work_ = nullptr;  ///< null: no loop
  std::size_t next_ = 0, count_ = 0;
  std::atomic<int> running_{0};          ///< turns
  std::atomic<std::uint32_t> loops_{0};  ///< so far
  std::atomic<bool> ended_{false};
  std::vector<std::jthread> beside_;
};

}  // namespace topple::solver
