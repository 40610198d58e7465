#include "topple/structure/step_thread.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

namespace topple::structure {

namespace {

using Clock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

/// Time by which steps may be behind and still be made as soon as they can, s: a few slow ones among many fast ones
/// leave no trace in simulated time. What is lost beyond it is not caught up: a run that jumps ahead is no picture of
/// motion.
constexpr double made_up_for = 0.1;
/// Time over which the ratio is told, s: long enough to be read, short enough to be of now.
constexpr double told_over = 1;

double between(Clock::time_point from, Clock::time_point to) { return Seconds(to - from).count(); }
Clock::duration duration(double seconds) {
  constexpr double for_ever = 1e8;  // the clock counts no farther than some hundred years
  return std::chrono::duration_cast<Clock::duration>(Seconds(std::min(seconds, for_ever)));
}

}  // namespace

struct StepThread::State {
  Work work;

  mutable std::mutex mutex;  ///< guards all below; never held while a step is made
  std::condition_variable woken;
  struct Order {
    std::function<void()> what;
    bool show = false;
  };
  std::vector<Order> orders;
  bool paused = false, quit = false, idle = false;
  double speed = 1;
  Clock::time_point due = Clock::now();  ///< of the next step
  Clock::time_point published = Clock::now();
  double way = 0;  ///< s in which the way from the state before to the last one is gone through; 0: it is not
  /// Steps made since the run last stood still: when, and how much simulated time had passed by then.
  struct Mark {
    Clock::time_point at;
    double simulated;
  };
  std::deque<Mark> marks;
  std::string error;

  std::thread thread;

  void run();
  void carry_out_orders();
  [[nodiscard]] bool wait_for_turn();
  void make_step();
  void publish(bool follows, double took);
  void stand_still(bool still) {
    idle = still;
    marks = {{Clock::now(), 0}};
  }
  [[nodiscard]] bool ended() const {
    const std::lock_guard lock(mutex);
    return quit;
  }
};

void StepThread::State::publish(bool follows, double took) {
  const std::lock_guard lock(mutex);
  work.publish(follows);
  published = Clock::now();
  way = follows ? std::max(work.length / speed, took) : 0;
  if (!follows) return stand_still(idle);
  marks.push_back({published, marks.back().simulated + work.length});
  while (marks.size() > 2 && between(marks[1].at, published) > told_over) marks.pop_front();
}

void StepThread::State::carry_out_orders() {
  std::vector<Order> now;
  {
    const std::lock_guard lock(mutex);
    now.swap(orders);
    if (!now.empty() && idle) stand_still(false);
  }
  for (const Order& order : now) {
    order.what();
    if (order.show) publish(false, 0);
  }
}

/// Sleeps until the next step is due. False: there is none to make, only orders, or the end.
bool StepThread::State::wait_for_turn() {
  std::unique_lock lock(mutex);
  const auto interrupted = [&] { return quit || !orders.empty(); };
  if (paused || idle) {
    woken.wait(lock, [&] { return interrupted() || !(paused || idle); });
    due = Clock::now();
    return false;
  }
  while (Clock::now() < due) {  // set_speed() may bring it nearer
    woken.wait_until(lock, due);
    if (interrupted() || paused) return false;
  }
  if (interrupted()) return false;
  due = std::max(due + duration(work.length / speed), Clock::now() - duration(made_up_for));
  return true;
}

void StepThread::State::make_step() {
  const Clock::time_point begun = Clock::now();
  if (work.step()) return publish(true, between(begun, Clock::now()));
  const std::lock_guard lock(mutex);
  stand_still(true);
}

void StepThread::State::run() {
  try {
    while (!ended()) {
      carry_out_orders();
      if (wait_for_turn()) make_step();
    }
  } catch (const std::exception& stopped) {
    const std::lock_guard lock(mutex);
    error = stopped.what();
    stand_still(true);
  }
}

StepThread::StepThread(Work work) : state_(std::make_unique<State>()) {
  state_->work = std::move(work);
  state_->paused = state_->work.paused;
  state_->stand_still(false);
  state_->thread = std::thread([state = state_.get()] { state->run(); });
}

StepThread::~StepThread() {
  {
    const std::lock_guard lock(state_->mutex);
    state_->quit = true;
    state_->woken.notify_all();
  }
  state_->thread.join();
}

void StepThread::order(std::function<void()> what, bool show) {
  const std::lock_guard lock(state_->mutex);
  state_->orders.push_back({std::move(what), show});
  state_->woken.notify_all();
}

void StepThread::inspect(const std::function<void(double share)>& at) const {
  const std::lock_guard lock(state_->mutex);
  const double since = between(state_->published, Clock::now());
  at(state_->way > 0 ? std::min(1.0, since / state_->way) : 1);
}

void StepThread::set_paused(bool paused) {
  const std::lock_guard lock(state_->mutex);
  if (std::exchange(state_->paused, paused) == paused) return;
  state_->stand_still(state_->idle);
  state_->woken.notify_all();
}

bool StepThread::paused() const {
  const std::lock_guard lock(state_->mutex);
  return state_->paused;
}

void StepThread::set_speed(double speed) {
  if (!(speed > 0)) throw std::invalid_argument("a speed must be above zero");
  const std::lock_guard lock(state_->mutex);
  if (std::exchange(state_->speed, speed) == speed) return;
  state_->due = std::min(state_->due, Clock::now() + duration(state_->work.length / speed));
  state_->stand_still(state_->idle);
  state_->woken.notify_all();
}

double StepThread::speed() const {
  const std::lock_guard lock(state_->mutex);
  return state_->speed;
}

double StepThread::ratio() const {
  const std::lock_guard lock(state_->mutex);
  const State& s = *state_;
  if (s.paused || s.idle) return 0;
  const Clock::time_point now = Clock::now();
  // What is seen counts, between two steps too: the last step's way as far as it has been gone through.
  const double way = s.way > 0 ? s.way : s.work.length / s.speed;
  const double seen = std::min(1.0, between(s.marks.back().at, now) / way) * s.work.length;
  const double passed = s.marks.back().simulated - s.marks.front().simulated + seen;
  const double elapsed = between(s.marks.front().at, now);
  return elapsed > 0 ? std::min(s.speed, passed / elapsed) : s.speed;
}

std::string StepThread::error() const {
  const std::lock_guard lock(state_->mutex);
  return state_->error;
}

}  // namespace topple::structure
