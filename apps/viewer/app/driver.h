#pragma once
// What moves a session on: a thread of its own behind a window, or the headless run's own loop.
#include <functional>
#include <memory>
#include <string>

#include "app/session.h"

namespace topple::viewer {

/// What to draw: between two snapshots.
struct Moment {
  std::shared_ptr<const Snapshot> earlier, later;
  double share = 1;
  [[nodiscard]] Snapshot interpolated() const {
    return earlier && share < 1 && earlier->step < later->step ? interpolate(*earlier, *later, share) : *later;
  }
};

class Driver {
 public:
  virtual ~Driver() = default;
  using Order = std::function<void(Session&)>;
  /// Does something with the session between two steps.
  virtual void order(Order what) = 0;
  /// The same, and what it changed is to be seen at once, also while paused.
  virtual void order_and_show(Order what) = 0;
  void apply(const structure::Tool& tool) {
    order([tool](Session& session) { session.apply(tool); });
  }
  void restart() {
    order_and_show([](Session& session) { session.restart(); });
  }
  void undo() {
    order_and_show([](Session& session) { (void)session.undo(); });
  }
  void single_step() {
    set_paused(true);
    order_and_show([](Session& session) { session.step(); });
  }
  virtual void set_paused(bool paused) = 0;
  [[nodiscard]] virtual bool paused() const = 0;
  /// Simulated seconds for each second.
  virtual void set_speed(double speed) = 0;
  [[nodiscard]] virtual double speed() const = 0;
  /// The same as it is: less than speed() while steps take longer than they last.
  [[nodiscard]] virtual double ratio() const = 0;
  [[nodiscard]] virtual Moment moment() const = 0;
  /// False: the building's first answer is still sought, and it is drawn as it stands unloaded.
  [[nodiscard]] virtual bool begun() const { return true; }
  [[nodiscard]] const Recording& recording() const { return *recording_; }

 protected:
  explicit Driver(std::shared_ptr<const Recording> recording) : recording_(std::move(recording)) {}

 private:
  std::shared_ptr<const Recording> recording_;
};

/// Steps when told to, on the caller's thread.
class DirectDriver : public Driver {
 public:
  explicit DirectDriver(Session& session)
      : Driver(session.recording()), session_(session), latest_(session.snapshot()) {}
  void advance();
  void order(Order what) override { what(session_); }
  void order_and_show(Order what) override;
  void set_paused(bool paused) override { paused_ = paused; }
  [[nodiscard]] bool paused() const override { return paused_; }
  void set_speed(double speed) override { speed_ = speed; }
  [[nodiscard]] double speed() const override { return speed_; }
  [[nodiscard]] double ratio() const override { return paused_ ? 0 : speed_; }
  [[nodiscard]] Moment moment() const override { return {nullptr, latest_, 1}; }

 private:
  Session& session_;
  std::shared_ptr<const Snapshot> latest_;
  bool paused_ = false;
  double speed_ = 1;
};

/// Steps on a thread of its own at the pace of real time (structure::StepThread); drawing reads the last two snapshots
/// and never waits for a step.
class ThreadDriver : public Driver {
 public:
  /// The session is the thread's alone from now on. `before_step` (unless empty) is called on it before each step:
  /// tests make steps slow by it.
  explicit ThreadDriver(std::unique_ptr<Session> session, std::function<void()> before_step = {});
  /// Makes the session of this building on the thread as well, as the first answer of a large one takes seconds. Until
  /// then moment() is the unloaded building, and orders wait.
  using SessionMaker = std::function<std::unique_ptr<Session>(std::shared_ptr<Recording> recording)>;
  ThreadDriver(const structure::Building& building, double step, SessionMaker make);
  ~ThreadDriver() override;
  void order(Order what) override;
  void order_and_show(Order what) override;
  void set_paused(bool paused) override;
  [[nodiscard]] bool paused() const override;
  void set_speed(double speed) override;
  [[nodiscard]] double speed() const override;
  [[nodiscard]] double ratio() const override;
  [[nodiscard]] Moment moment() const override;
  [[nodiscard]] bool begun() const override;
  /// Throws what the making of the session threw, if it did.
  void require_beginning() const;
  /// Why the simulation stopped, when it threw; empty otherwise.
  [[nodiscard]] std::string error() const;

 private:
  ThreadDriver(const structure::Building& building, double step, SessionMaker make,
               std::shared_ptr<Recording> recording);
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace topple::viewer
