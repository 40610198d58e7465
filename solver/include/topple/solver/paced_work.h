#pragma once
// Work that is done a part at a time: it stops wherever it has spent what it was granted, in the middle of a
// factorisation if need be, and goes on from there when it is granted more. It has a stack of its own, but never runs
// beside its owner: one of the two always waits for the other, so that nothing needs a lock and everything comes in one
// order.
//
// It is done once it has ended and what it spent is granted, wherever it stopped in between: whether it was run on to
// its end at once because somebody wanted to look, or several threads shared a part that cannot stop, changes nothing.
#include <functional>
#include <memory>

namespace topple::solver {

/// Whoever computes tells here what it has taken (predicted, 20 operations for a nanosecond of the machine on which the
/// costs in ladder_costs.cpp were measured). Inside of paced work that may be where it waits for more; elsewhere it
/// does nothing.
void spend(double operations);

/// What this thread has spent so far; inside of paced work, what its owner's pieces of work have.
[[nodiscard]] double spent_here();

/// What spend() counts for so many: sums of whole numbers do not depend on their order.
[[nodiscard]] double whole_operations(double operations);

/// Operations for each nanosecond of the machine on which costs were measured.
constexpr double operations_per_nanosecond = 20;

/// What a loop spends, told some of it at a time.
class Spending {
 public:
  Spending() = default;
  ~Spending() { spend(taken_); }
  Spending(const Spending&) = delete;
  Spending& operator=(const Spending&) = delete;
  void add(double operations) {
    constexpr double at_once = 4e5;
    taken_ += operations;
    if (taken_ < at_once) return;
    spend(taken_);
    taken_ = 0;
  }

 private:
  double taken_ = 0;
};

class PacedWork {
 public:
  PacedWork();
  /// Work under way is run to its end.
  ~PacedWork();
  PacedWork(const PacedWork&) = delete;
  PacedWork& operator=(const PacedWork&) = delete;

  /// Takes work up; it begins with the first grant. Only when done().
  void begin(std::function<void()> work);
  /// True when there is none, or it has ended and is paid for.
  [[nodiscard]] bool done() const;
  /// It is what runs on the calling thread.
  [[nodiscard]] bool runs_here() const;
  /// Goes on for so many operations more, at least 0. Returns those of them that it left; 0 when it is not done. What
  /// the work throws is thrown here, and the work is done.
  double go_on(double operations);
  /// Runs on to the end, which waits to be paid for all the same. Does nothing when asked by the work itself.
  void run_out();
  /// Runs on to the end, and is done. Returns what it spent beyond what was granted.
  double finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
  friend void spend(double operations);
  friend double spent_here();
};

}  // namespace topple::solver
