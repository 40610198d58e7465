#pragma once
// The law of impact (impact.h) between bodies, and of bodies on the ground, on what stands firm, and on what stands and
// moves.
#include <optional>
#include <span>
#include <vector>

#include "simulation/accounts/event_log.h"
#include "simulation/accounts/running_sums.h"
#include "simulation/debris/break_up.h"
#include "simulation/impact/body_impact.h"
#include "simulation/impact/impact.h"
#include "simulation/impact/standing_impacts.h"
#include "simulation/impact/struck_clock.h"
#include "simulation/impact/struck_joints.h"
#include "simulation/impact/yielding_push.h"

namespace topple::structure {

class BodyImpacts {
 public:
  /// What it looks at and changes; all of it must outlive it.
  struct Sources {
    Scene& scene;
    EventLog& log;
    RunningSums& sums;
    Debris& debris;
    BreakUp& break_up;
    StandingImpacts& standing;
    const StruckClocks& struck;
  };
  explicit BodyImpacts(const Sources& sources);

  /// Contacts of the next `dt` that come hard and of which something can break, in order of time.
  void strike_all(const std::vector<collision::Contact>& contacts, double dt);
  /// Whether the law of impact has a contact, rather than the collision world: it is fast, or what stands and moves is
  /// met by so much momentum that to take it within `dt` might break it.
  [[nodiscard]] bool comes_hard(const collision::Contact& contact, double dt) const;

  /// It has nothing of its own.
  template <class Archive>
  void serialize(Archive&) {
    [[maybe_unused]] auto& [scene, log, sums, debris, break_up, standing, struck] = *this;
  }

 private:
  /// One push of an impact that goes on while places close.
  struct Pass {
    double least_speed;  ///< m/s, of a place that closes
    double restitution;
    double most_unlike;  ///< places by frequency, that are followed together
  };
  [[nodiscard]] std::optional<collision::Contact> contact_now(const collision::Contact& swept) const;
  void strike(const std::vector<collision::Contact>& contacts, double least_speed);
  [[nodiscard]] BodyImpact impact_of(const std::vector<collision::Contact>& contacts) const;
  [[nodiscard]] bool choose_places(BodyImpact& impact, const Pass& pass);
  [[nodiscard]] bool push(BodyImpact& impact, const Pass& pass, std::optional<std::size_t>& told);
  [[nodiscard]] ImpactSide side_at(collision::BodyId id, double time) const;
  [[nodiscard]] double time_since_state(collision::BodyId id, double swept_at) const;
  [[nodiscard]] ImpactSide side_again(const ImpactSide& side, collision::BodyId id) const;
  void set_side(const ImpactSide& side);
  void find_flexibility(ImpactSide& side, const std::vector<ImpactPlace>& places, double sign);
  void find_held(ImpactSide& side, const std::vector<ImpactPlace>& places);
  void leave_with_restitution(BodyImpact& impact, const YieldingPush& yielding, double restitution);
  void account_turns_of(const std::vector<JointBreak>& broken, const YieldingPush& yielding);
  void keep_turns(const YieldingPush& yielding);
  void account_turns(std::vector<StandingFrame::ImpactTurn> turns, const YieldingPush& yielding);
  [[nodiscard]] bool prepare_push(BodyImpact& impact);
  [[nodiscard]] Impact begin_push(const BodyImpact& impact, bool follows) const;
  [[nodiscard]] Impact::Utilisation record_utilisations(const std::vector<StruckJoint>& joints,
                                                        const YieldingJoints& hinges, std::vector<double>& uses,
                                                        double& moment) const;
  [[nodiscard]] static bool later(const BodyImpact& impact, const Eigen::VectorXd& impulses);
  [[nodiscard]] double deepest_push(const BodyImpact& impact) const;
  [[nodiscard]] std::vector<StruckJoint> struck_joints(const BodyImpact& impact, const YieldingJoints& yielding) const;
  std::size_t record(const BodyImpact& impact, double speed_in);
  void give_impulses(BodyImpact& impact, const Eigen::VectorXd& impulses);
  std::vector<std::size_t> record_breaks(const std::vector<JointBreak>& broken);
  bool fall_apart(BodyImpact& impact, const std::vector<JointBreak>& broken);
  bool break_joints(BodyImpact& impact, Impact& push, YieldingPush& yielding, const std::vector<JointBreak>& broken);

  Scene& scene_;
  EventLog& log_;
  RunningSums& sums_;
  Debris& debris_;
  BreakUp& break_up_;
  StandingImpacts& standing_;
  const StruckClocks& struck_;
};

}  // namespace topple::structure
