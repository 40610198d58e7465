#include "app/driver.h"

#include <exception>
#include <utility>

#include "topple/structure/step_thread.h"

namespace topple::viewer {

void DirectDriver::advance() {
  if (paused_) return;
  session_.step();
  latest_ = session_.snapshot();
}
void DirectDriver::order_and_show(Order what) {
  what(session_);
  latest_ = session_.snapshot();
}

struct ThreadDriver::State {
  std::unique_ptr<Session> session;  ///< touched by the thread alone
  std::exception_ptr failed;         ///< of its making; read once the thread has told that it ended
  std::function<void()> before_step;
  std::shared_ptr<const Snapshot> made;
  std::shared_ptr<const Snapshot> earlier, later;  ///< handed over while nobody looks
  bool begun = false;                              ///< so is this
  std::unique_ptr<structure::StepThread> thread;

  void begin(const SessionMaker& make, std::shared_ptr<Recording> recording) {
    try {
      session = make(std::move(recording));
      made = session->snapshot();
    } catch (...) {
      failed = std::current_exception();
      throw;
    }
  }
  bool step() {
    if (before_step) before_step();
    session->step();
    made = session->snapshot();
    return true;
  }
  void publish(bool follows) {
    earlier = follows ? later : nullptr;
    later = made;
    begun = session != nullptr;
  }
  /// Steps of this length (s).
  void start(double length, bool paused) {
    structure::StepThread::Work work;
    work.length = length;
    work.step = [this] { return step(); };
    work.publish = [this](bool follows) { publish(follows); };
    work.paused = paused;
    thread = std::make_unique<structure::StepThread>(std::move(work));
  }
};

ThreadDriver::ThreadDriver(std::unique_ptr<Session> session, std::function<void()> before_step)
    : Driver(session->recording()), state_(std::make_unique<State>()) {
  State* const s = state_.get();
  s->session = std::move(session);
  s->before_step = std::move(before_step);
  s->made = s->session->snapshot();
  s->publish(false);
  s->start(s->session->scenario().step, false);
}

ThreadDriver::ThreadDriver(const structure::Building& building, double step, SessionMaker make)
    : ThreadDriver(building, step, std::move(make), std::make_shared<Recording>()) {}

ThreadDriver::ThreadDriver(const structure::Building& building, double step, SessionMaker make,
                           std::shared_ptr<Recording> recording)
    : Driver(recording), state_(std::make_unique<State>()) {
  State* const s = state_.get();
  s->made = std::make_shared<const Snapshot>(undeformed(building));
  // There is something to look at; the session's own first snapshot takes its place.
  recording->add(*s->made);
  s->publish(false);
  // No step before the session is there.
  s->start(step, true);
  s->thread->order([s, make = std::move(make), recording = std::move(recording)] { s->begin(make, recording); }, true);
  s->thread->set_paused(false);
}

ThreadDriver::~ThreadDriver() = default;

void ThreadDriver::order(Order what) {
  state_->thread->order([s = state_.get(), what = std::move(what)] { what(*s->session); });
}
void ThreadDriver::order_and_show(Order what) {
  state_->thread->order(
      [s = state_.get(), what = std::move(what)] {
        what(*s->session);
        s->made = s->session->snapshot();
      },
      true);
}
void ThreadDriver::set_paused(bool paused) { state_->thread->set_paused(paused); }
bool ThreadDriver::paused() const { return state_->thread->paused(); }
void ThreadDriver::set_speed(double speed) { state_->thread->set_speed(speed); }
double ThreadDriver::speed() const { return state_->thread->speed(); }
double ThreadDriver::ratio() const { return state_->thread->ratio(); }
Moment ThreadDriver::moment() const {
  Moment moment;
  state_->thread->inspect([&](double share) { moment = {state_->earlier, state_->later, share}; });
  return moment;
}
bool ThreadDriver::begun() const {
  bool begun = false;
  state_->thread->inspect([&](double) { begun = state_->begun; });
  return begun;
}
void ThreadDriver::require_beginning() const {
  if (!error().empty() && state_->failed) std::rethrow_exception(state_->failed);
}
std::string ThreadDriver::error() const { return state_->thread->error(); }

}  // namespace topple::viewer
