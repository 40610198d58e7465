#pragma once
// Which bodies sleep: those of islands that have been slow for some time and that forces within the friction cones
// hold.
#include <span>
#include <vector>

#include "debris/contact_report.h"

namespace topple::collision {

/// Seeks for islands that can rest.
class DebrisRest {
 public:
  DebrisRest(DebrisScene& scene, SolvedIslands& solved, ContactReport& told)
      : scene_(scene), solved_(solved), report_(told) {}

  /// How long each body has stayed where it is: after each part of a step, `dt` long.
  void watch(std::span<const Island> islands, double dt);
  /// Before the step is solved: those of the islands whose bodies have been slow for some time stay where they are, if
  /// there are forces that hold them. True when any fell asleep.
  bool fall_asleep(std::span<Island> islands, double dt);
  /// What fell asleep in this step wakes at rest from now on. One that was woken within it went on as it was.
  void end_step(double dt);

 private:
  [[nodiscard]] bool fall_asleep(Island& island, double dt);
  [[nodiscard]] Island quiet_part(const Island& island) const;
  [[nodiscard]] Island with_sleeping(const Island& island) const;
  [[nodiscard]] Island awake_on(const Island& whole) const;
  [[nodiscard]] bool swings(const DebrisBody& body) const;

  DebrisScene& scene_;
  SolvedIslands& solved_;
  ContactReport& report_;
  std::vector<std::int64_t> slept_now_;  ///< bodies that fell asleep in this step
};

}  // namespace topple::collision
