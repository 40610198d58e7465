#pragma once
// What stands and moves, as the collision world meets it: debris and frame share substeps. Each hands the other what it
// did in a substep: the world forces of contacts and hinges, the frame where its parts are and how fast.
#include <functional>
#include <map>

#include "simulation/accounts/running_sums.h"
#include "simulation/debris/debris.h"
#include "simulation/debris/hinges.h"
#include "simulation/debris/parting.h"

namespace topple::structure {

class MovingParts final : public collision::MovingStructure {
 public:
  /// Of the frame, with all that comes of it.
  struct Substep {
    std::function<void()> advance;
    /// After it: what debris comes upon in the next one, of this length in s.
    std::function<void(double dt)> strike;
  };
  /// All must outlive it.
  MovingParts(Debris& debris, Hinges& hinges, RunningSums& sums, Substep substep)
      : debris_(debris), hinges_(hinges), sums_(sums), substep_(std::move(substep)) {}

  [[nodiscard]] std::optional<collision::ObstacleMotion> motion(collision::ObstacleId obstacle) override;
  [[nodiscard]] std::optional<collision::ObstaclePath> path(collision::ObstacleId obstacle) const override;
  void advance(double dt, std::span<const collision::Contact> contacts,
               std::span<const collision::HingePull> pulls) override;

  template <class Archive>
  void serialize(Archive& archive) {
    auto& [known, debris, hinges, sums, substep] = *this;
    archive(known);
  }

 private:
  struct Known {
    PartMotion velocity;      ///< at the start of the substep
    PartMotion acceleration;  ///< mean of the last one
    bool held_anew = false;   ///< something broke in it
  };
  template <class Archive>
  friend void serialize(Archive& archive, Known& known) {
    auto& [velocity, acceleration, held_anew] = known;
    archive(velocity, acceleration, held_anew);
  }
  /// Of a part, or of a place that hinges hold to, that moves.
  [[nodiscard]] std::optional<PartMotion> velocity(collision::ObstacleId obstacle) const;
  [[nodiscard]] PartMotion foreseen_acceleration(collision::ObstacleId obstacle) const;
  [[nodiscard]] collision::ObstacleMotion pose_and_mass(collision::ObstacleId obstacle) const;
  [[nodiscard]] std::vector<PartingContact> may_part(std::span<const collision::Contact> contacts) const;
  /// By obstacle: those that were asked for since the last substep.
  std::map<std::int64_t, Known> known_;
  Debris& debris_;
  Hinges& hinges_;
  RunningSums& sums_;
  Substep substep_;
};

}  // namespace topple::structure
