#pragma once
// What stands and moves, as the collision world meets it: debris and frame share substeps. Each hands the other what it
// did in a substep: the world contact forces, the frame where its parts are and how fast.
#include <functional>
#include <map>

#include "simulation/accounts/running_sums.h"
#include "simulation/debris/debris.h"
#include "simulation/debris/parting.h"

namespace topple::structure {

class MovingParts final : public collision::MovingStructure {
 public:
  /// Both must outlive it. `substep` takes one of the frame, with all that comes of it.
  MovingParts(Debris& debris, RunningSums& sums, std::function<void()> substep)
      : debris_(debris), sums_(sums), substep_(std::move(substep)) {}

  [[nodiscard]] std::optional<collision::ObstacleMotion> motion(collision::ObstacleId obstacle) override;
  void advance(double dt, std::span<const collision::Contact> contacts,
               std::span<const collision::HingePull> pulls) override;

 private:
  struct Known {
    PartMotion velocity;      ///< at the start of the substep
    PartMotion acceleration;  ///< mean of the last one
    bool held_anew = false;   ///< something broke in it
  };
  [[nodiscard]] PartMotion velocity(Part part) const;
  [[nodiscard]] std::vector<PartingContact> may_part(std::span<const collision::Contact> contacts) const;
  /// By obstacle: those that were asked for since the last substep.
  std::map<std::int64_t, Known> known_;
  Debris& debris_;
  RunningSums& sums_;
  std::function<void()> substep_;
};

}  // namespace topple::structure
