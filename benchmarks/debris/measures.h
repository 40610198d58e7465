#pragma once
// What a scene of debris costs and how true it is: its run, measured step by step.
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>

#include "body_balances.h"
#include "overlaps.h"

namespace topple::bench {

struct DebrisMeasures {
  std::size_t bodies = 0;
  double milliseconds = 0;  ///< of a step while anything is awake, median
  double worst_milliseconds = 0;
  std::size_t awake_steps = 0;
  Overlaps at_end;
  double deepest = 0;                ///< m, of all looks
  std::optional<double> rest;        ///< s: asleep from then on; none: not within the scene
  std::optional<double> settled_at;  ///< s: the mean speed stays below 20 mm/s from then on
  double height = 0;                 ///< m: of the centres of mass at the end, mean
  Residuals awake, asleep;
  std::optional<double> created;  ///< energy that came from nowhere over what the fall took out; none: nothing fell
  double momentum = 0;            ///< that no impulse accounts for, over the most sum of mass times speed
  std::optional<double> angular;  ///< the same of angular momentum, where nothing stands and nothing pulls
  std::uint64_t bits = 0;         ///< of all states of all steps
};

/// Of the processor, or of the clock on the wall: what several threads share.
enum class StepTime { processor, clock };

using MakeWorld = std::function<std::unique_ptr<collision::World>()>;

/// Overlaps are looked at each tenth of a second.
[[nodiscard]] DebrisMeasures measure_debris(const DebrisScene& scene, const MakeWorld& make_world);
/// The same run, without a look at anything but times and bits.
[[nodiscard]] DebrisMeasures time_debris(const DebrisScene& scene, const MakeWorld& make_world, StepTime by);

}  // namespace topple::bench
