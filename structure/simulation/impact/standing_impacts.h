#pragma once
// The law of impact for what strikes a frame whose standing is static, and for hits that punch a panel: contacts one
// after the other by time of impact (indentation.h), those of a body at one instant together (strike_together.cpp).
#include <optional>
#include <span>
#include <vector>

#include "simulation/debris/release_impulses.h"
#include "simulation/fracture/standing_fracture.h"
#include "simulation/impact/indentation.h"
#include "simulation/impact/strike.h"
#include "simulation/impact/struck_clock.h"

namespace topple::structure {

class StandingImpacts {
 public:
  /// What it looks at and changes; all of it must outlive it.
  struct Sources {
    Scene& scene;
    EventLog& log;
    RunningSums& sums;
    Debris& debris;
    const BreakablePanels& panels;
    StandingFracture& fracture;
    ReleaseImpulses& release_impulses;
    StruckClocks& struck;
  };
  explicit StandingImpacts(const Sources& sources);

  /// Contacts of this step that are fast enough: on what stands, in order of time.
  void strike_all(const std::vector<collision::Contact>& contacts);
  /// punch_moving.cpp: where what stands moves, a hit that punches a hole. False when the contact is none, and nothing
  /// has happened.
  [[nodiscard]] bool punch_moving(const collision::Contact& contact);

  /// It has nothing of its own.
  template <class Archive>
  void serialize(Archive&) {
    [[maybe_unused]] auto& [scene, log, sums, debris, panels, fracture, release_impulses, struck] = *this;
  }

 private:
  struct SimultaneousImpact;
  void strike(const collision::Contact& contact);
  [[nodiscard]] std::optional<Strike> aim(const collision::Contact& contact);
  [[nodiscard]] double rebound(const Indentation& pushing) const;
  [[nodiscard]] bool breaks_nothing(Strike& hit, double weight, double punching);
  void run_impact(Strike& hit);
  static void record_loss(Strike& hit);
  void set_motion_after(const Strike& hit);
  void record_impact(const Strike& hit);
  void keep_release_impulse(const Strike& hit);
  void move_on(const Strike& hit, collision::BodyState after, std::span<const PointImpulse> impulses);
  void check_momentum(const Strike& hit, std::span<const PointImpulse> impulses);
  [[nodiscard]] bool joint_fails_below(const StandingFrame::HeldResponse& response, double force) const;
  // strike_together.cpp: several of them at one instant.
  [[nodiscard]] bool strike_together(std::span<const collision::Contact* const> contacts);
  [[nodiscard]] bool prepare_push(SimultaneousImpact& pushed) const;
  [[nodiscard]] bool breaks_nothing(SimultaneousImpact& pushed);
  void run_impact(SimultaneousImpact& pushed);
  void go_on(SimultaneousImpact& pushed, const Eigen::VectorXd& shift);
  void set_motion_after(SimultaneousImpact& pushed);

  Scene& scene_;
  EventLog& log_;
  RunningSums& sums_;
  Debris& debris_;
  const BreakablePanels& panels_;
  StandingFracture& fracture_;
  ReleaseImpulses& release_impulses_;
  StruckClocks& struck_;
};

}  // namespace topple::structure
