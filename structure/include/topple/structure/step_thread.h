#pragma once
// Steps made on a thread of their own at the pace of the clock. While they keep up, simulated time is real time times
// the speed asked for; while they do not it runs slower, never in coarser steps. Which steps are made and what comes of
// them does not depend on the pace.
#include <functional>
#include <memory>
#include <string>

namespace topple::structure {

/// A thread that makes steps.
class StepThread {
 public:
  /// What the thread does. All is called on it.
  struct Work {
    double length = 1.0 / 60;    ///< of a step, simulated s
    std::function<bool()> step;  ///< makes one; false: there is none to make before the next order
    /// What the last step or order made is from now on what is looked at. Called while nobody looks: pointers change
    /// hands, nothing is computed. `follows`: a step led there from what was looked at before.
    std::function<void(bool follows)> publish;
    bool paused = false;  ///< at first
  };
  /// Begins at once, unless Work::paused.
  explicit StepThread(Work work);
  /// Waits for the step under way.
  ~StepThread();
  StepThread(const StepThread&) = delete;
  StepThread& operator=(const StepThread&) = delete;

  /// Does something on the thread between two steps, in the order of these calls. `show`: then publishes, also while
  /// paused.
  void order(std::function<void()> what, bool show = false);
  /// Calls `at` with the share of the way from the state before the last to the last one, from 0 to 1, at which the
  /// clock is now. It never waits for a step; nothing is published meanwhile. A step that took longer than it lasts is
  /// gone through as slowly as it was made.
  void inspect(const std::function<void(double share)>& at) const;

  /// Stops before the next step, or goes on.
  void set_paused(bool paused);
  /// As it was last set.
  [[nodiscard]] bool paused() const;
  /// Simulated seconds for each second, above 0; at most so many where steps do not keep up.
  void set_speed(double speed);
  /// As it was last set.
  [[nodiscard]] double speed() const;
  /// Simulated seconds for each second that there are: speed() while steps keep up, less while they do not. Over about
  /// the last second, or the step under way where that takes longer; 0 while paused or without a step to make.
  [[nodiscard]] double ratio() const;
  /// Why the steps ended, when one or an order threw; empty otherwise.
  [[nodiscard]] std::string error() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace topple::structure
