#include "progress.h"

#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <mutex>
#include <string>
#include <thread>

namespace topple::app {

namespace {

using Clock = std::chrono::steady_clock;

constexpr double quiet = 1;      // s: shorter runs say nothing, longer ones no more often
constexpr double heartbeat = 5;  // s: within a stage that says nothing of itself

const Clock::time_point begin = Clock::now();

double now() { return std::chrono::duration<double>(Clock::now() - begin).count(); }

/// What is going on, said by a thread of its own, so that a stage of a minute does not look like none.
class Teller {
 public:
  Teller() : thread_([this](const std::stop_token& stop) { run(stop); }) {}

  void report(std::string_view stage, double share) {
    const std::scoped_lock guard(lock_);
    if (stage != stage_) since_ = now();
    fresh_ = stage != stage_ || share != share_;
    stage_ = stage;
    share_ = share;
    if (fresh_ && now() - last_ >= quiet && now() >= quiet) say();
  }

 private:
  void run(const std::stop_token& stop) {
    std::unique_lock guard(lock_);
    while (!stop.stop_requested()) {
      wake_.wait_for(guard, stop, std::chrono::milliseconds(100), [] { return false; });
      const double silent = now() - last_;
      if (stop.stop_requested() || stage_.empty() || now() < quiet) continue;
      if (silent >= heartbeat || (fresh_ && silent >= quiet)) say();
    }
  }

  void say() {
    last_ = now();
    fresh_ = false;
    std::string text = stage_;
    char number[32];
    if (share_ >= 0) {
      std::snprintf(number, sizeof number, ", %.0f %%", 100 * share_);
      text += number;
    } else if (last_ - since_ >= quiet) {
      std::snprintf(number, sizeof number, " for %.0f s", last_ - since_);
      text += number;
    }
    std::fprintf(stderr, "topple: %.0f s, %s\n", last_, text.c_str());
  }

  std::mutex lock_;
  std::condition_variable_any wake_;
  std::string stage_;
  double share_ = -1, last_ = 0, since_ = 0;
  bool fresh_ = false;
  std::jthread thread_;  ///< last: it ends before what it reads
};

}  // namespace

void report_progress(std::string_view stage, double share) {
  static Teller teller;
  teller.report(stage, share);
}

}  // namespace topple::app
