#pragma once
// A second stack: what runs on it waits wherever it is, in the middle of anything, and goes on when its owner lets it.
// One of the two always waits for the other. Where the system can switch stacks (ucontext) that takes a fraction of a
// microsecond; elsewhere, and under sanitizers, which must know of every stack, a thread lends its own, and waking it
// takes tens of microseconds.
#include <functional>
#include <memory>

namespace topple::solver {

class Strand {
 public:
  /// `body` begins with the first run(). It must have returned before the strand ends, unless it never began.
  explicit Strand(std::function<void()> body);
  ~Strand();
  Strand(const Strand&) = delete;
  Strand& operator=(const Strand&) = delete;

  /// By the owner: until the body waits or returns. The body must not throw.
  void run();
  /// By the body: until the owner runs it again, perhaps from another thread.
  void wait();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace topple::solver
