#include "progress.h"

#include <chrono>
#include <cstdio>
#include <mutex>
#include <string>

namespace topple::app {

namespace {

using Clock = std::chrono::steady_clock;

constexpr double quiet = 1;  // s: shorter runs say nothing, longer ones no more often

const Clock::time_point begin = Clock::now();

}  // namespace

void tell_progress(std::string_view stage, double share) {
  static std::mutex lock;
  static double last = 0;
  const std::scoped_lock guard(lock);
  const double now = std::chrono::duration<double>(Clock::now() - begin).count();
  if (now < quiet || (last > 0 && now - last < quiet)) return;
  last = now;
  const std::string name(stage);
  if (share < 0)
    std::fprintf(stderr, "topple: %.0f s, %s\n", now, name.c_str());
  else
    std::fprintf(stderr, "topple: %.0f s, %s, %.0f %%\n", now, name.c_str(), 100 * share);
}

}  // namespace topple::app
