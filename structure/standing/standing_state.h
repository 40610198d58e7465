#pragma once
// What a StandingFrame is made of: the structural state, and the parts that change it. The step of what moves is
// standing/motion/standing_sway.cpp.
#include <map>
#include <utility>

#include "standing/damage/generations.h"
#include "standing/damage/queued_changes.h"

namespace topple::structure {

struct StandingFrame::State : StructuralState {
  State(const Building& building, CombinationId combination, const FailureRules& rules, int threads);

  void settle(int generations);

  // standing_archive.cpp
  template <class Archive>
  void serialize(Archive& archive);

  // Motion (standing_sway.cpp).
  void make_motion(const MotionSettings& settings);
  void move_on(const std::function<void()>& after_substep);
  void end_motion();
  void soften_at_rest();
  void begin_motion();
  void sway(int component);
  void break_in_motion(JointId joint, const Vec6& demand, double freed);
  void break_edges_over(int component);
  void follow_breaks();
  void leave_small_displacements(int component);
  void let_mechanisms_go(int component);
  void read_motion(int component);
  void check_rest(int component);
  [[nodiscard]] std::map<int, std::vector<Eigen::Index>> contacts_by_component(const HeldResponse& pushed) const;
  void add_hinges(int component, HeldResponse& answer);

  BreakLog breaks;  ///< of the settle() or impact that runs
  YieldingWay yielding;
  JointAnswers answers;
  SlowChanges slow;
  Departures departures;
  ShellDamage shell_damage;
  StandingDamage damage;
  StandingRelease release;
  Generations generations;
  QueuedChanges queue;

  bool pending = false;
  bool slowly = false;      ///< what changes now does so slowly: what is at rest goes on resting
  int substeps = 1;         ///< of a move()
  double rested_freed = 0;  ///< J that the account of rest says were freed where motion had its own
  std::uint64_t idle_settles = 0;
  mutable FrameCounters counters;
};

}  // namespace topple::structure
