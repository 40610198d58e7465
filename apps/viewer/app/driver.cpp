#include "app/driver.h"

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

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

using Clock = std::chrono::steady_clock;

struct ThreadDriver::State {
  std::unique_ptr<Session> session;  ///< touched by the thread alone
  double step_length;

  mutable std::mutex mutex;  ///< guards all below; held for copies of pointers only
  std::condition_variable woken;
  std::vector<std::function<void(Session&)>> orders;
  bool paused = false, quit = false;
  double speed = 1;
  std::shared_ptr<const Snapshot> earlier, later;
  Clock::time_point published = Clock::now();
  std::string error;

  std::thread thread;

  void run();
  void carry_out_orders();
  void publish(bool continues);
  bool wait_for_turn(Clock::time_point& due);
  void order(std::function<void(Session&)> what) {
    const std::lock_guard lock(mutex);
    orders.push_back(std::move(what));
    woken.notify_all();
  }
};

void ThreadDriver::State::publish(bool continues) {
  auto snapshot = session->snapshot();
  const std::lock_guard lock(mutex);
  earlier = continues ? later : nullptr;
  later = std::move(snapshot);
  published = Clock::now();
}

void ThreadDriver::State::carry_out_orders() {
  std::vector<std::function<void(Session&)>> now;
  {
    const std::lock_guard lock(mutex);
    now.swap(orders);
  }
  for (const auto& what : now) what(*session);
}

/// Sleeps until the next step is due. False: there is no step to make, only orders, or the end.
bool ThreadDriver::State::wait_for_turn(Clock::time_point& due) {
  std::unique_lock lock(mutex);
  const auto interrupted = [&] { return quit || !orders.empty(); };
  if (paused) {
    woken.wait(lock, [&] { return interrupted() || !paused; });
    due = Clock::now();
    return false;
  }
  if (woken.wait_until(lock, due, [&] { return interrupted() || paused; })) return false;
  const auto period = std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(step_length / speed));
  // A step that took too long is not caught up: the picture runs slower instead.
  due = std::max(due + period, Clock::now() - period);
  return true;
}

void ThreadDriver::State::run() {
  Clock::time_point due = Clock::now();
  try {
    while (true) {
      carry_out_orders();
      {
        const std::lock_guard lock(mutex);
        if (quit) return;
      }
      if (!wait_for_turn(due)) continue;
      session->step();
      publish(true);
    }
  } catch (const std::exception& stopped) {
    const std::lock_guard lock(mutex);
    error = stopped.what();
  }
}

ThreadDriver::ThreadDriver(std::unique_ptr<Session> session)
    : Driver(session->recording()), state_(std::make_unique<State>()) {
  state_->step_length = session->scenario().step;
  state_->session = std::move(session);
  state_->publish(false);
  state_->thread = std::thread([state = state_.get()] { state->run(); });
}

ThreadDriver::~ThreadDriver() {
  {
    const std::lock_guard lock(state_->mutex);
    state_->quit = true;
    state_->woken.notify_all();
  }
  state_->thread.join();
}

void ThreadDriver::order(Order what) { state_->order(std::move(what)); }
void ThreadDriver::order_and_show(Order what) {
  state_->order([what = std::move(what), state = state_.get()](Session& session) {
    what(session);
    state->publish(false);
  });
}
void ThreadDriver::set_paused(bool paused) {
  const std::lock_guard lock(state_->mutex);
  state_->paused = paused;
  state_->woken.notify_all();
}
bool ThreadDriver::paused() const {
  const std::lock_guard lock(state_->mutex);
  return state_->paused;
}
void ThreadDriver::set_speed(double speed) {
  const std::lock_guard lock(state_->mutex);
  state_->speed = speed;
}
double ThreadDriver::speed() const {
  const std::lock_guard lock(state_->mutex);
  return state_->speed;
}
Moment ThreadDriver::moment() const {
  const std::lock_guard lock(state_->mutex);
  const double since = std::chrono::duration<double>(Clock::now() - state_->published).count();
  return {state_->earlier, state_->later, std::min(1.0, since * state_->speed / state_->step_length)};
}
std::string ThreadDriver::error() const {
  const std::lock_guard lock(state_->mutex);
  return state_->error;
}

}  // namespace topple::viewer
