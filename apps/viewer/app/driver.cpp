#include "app/driver.h"

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
  std::function<void()> before_step;
  std::shared_ptr<const Snapshot> made;
  std::shared_ptr<const Snapshot> earlier, later;  ///< handed over while nobody looks
  std::unique_ptr<structure::StepThread> thread;

  bool step() {
    if (before_step) before_step();
    session->step();
    made = session->snapshot();
    return true;
  }
  void publish(bool follows) {
    earlier = follows ? later : nullptr;
    later = made;
  }
};

ThreadDriver::ThreadDriver(std::unique_ptr<Session> session, std::function<void()> before_step)
    : Driver(session->recording()), state_(std::make_unique<State>()) {
  State* const s = state_.get();
  s->session = std::move(session);
  s->before_step = std::move(before_step);
  s->made = s->session->snapshot();
  s->publish(false);
  structure::StepThread::Work work;
  work.length = s->session->scenario().step;
  work.step = [s] { return s->step(); };
  work.publish = [s](bool follows) { s->publish(follows); };
  s->thread = std::make_unique<structure::StepThread>(std::move(work));
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
  state_->thread->look([&](double share) { moment = {state_->earlier, state_->later, share}; });
  return moment;
}
std::string ThreadDriver::error() const { return state_->thread->error(); }

}  // namespace topple::viewer
