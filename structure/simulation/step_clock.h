#pragma once
// Which step an instant belongs to: step k >= 1 ends at k dt, and an event acts in the first step with
// k dt >= at - 1e-6 dt.
#include <cmath>
#include <cstdint>

namespace topple::structure {

/// Share of a step by which an event may be early, so that 0.1 s is step 6 of 60 Hz whatever the rounding.
inline constexpr double event_tolerance = 1e-6;

[[nodiscard]] inline std::int64_t step_of(double at, double dt) {
  const double limit = at - event_tolerance * dt;
  auto step = static_cast<std::int64_t>(std::ceil(limit / dt));
  // the quotient rounds: settle on the definition itself
  while (step > 1 && static_cast<double>(step - 1) * dt >= limit) --step;
  while (static_cast<double>(step) * dt < limit) ++step;
  return step < 1 ? 1 : step;
}

}  // namespace topple::structure
