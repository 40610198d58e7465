#pragma once
// What a Simulation is made of, and its stages. Each stage has a file of its own.
#include <map>

#include "simulation/accounts/event_log.h"
#include "simulation/accounts/piece_views.h"
#include "simulation/accounts/running_sums.h"
#include "simulation/debris/break_up.h"
#include "simulation/debris/debris.h"
#include "simulation/debris/hinges.h"
#include "simulation/debris/moving_parts.h"
#include "simulation/debris/release_impulses.h"
#include "simulation/fracture/breakable_panels.h"
#include "simulation/fracture/debris_fracture.h"
#include "simulation/fracture/standing_fracture.h"
#include "simulation/impact/body_impacts.h"
#include "simulation/impact/standing_impacts.h"
#include "simulation/scene.h"
#include "simulation/tool_actions.h"

namespace topple::structure {

struct Simulation::State {
  State(Building the_building, Scenario the_scenario, SimulationOptions the_options);
  ~State();

  // sweep.cpp
  [[nodiscard]] std::vector<collision::Contact> sweep();
  [[nodiscard]] Bounds swept_bounds(const Body& body, const collision::BodyState& state) const;
  struct Sweep {
    Vec3 travel;
    double turned_by;
  };
  [[nodiscard]] Sweep sweep_of(const collision::BodyState& state, double radius) const;
  [[nodiscard]] bool stays(const BodyMotion& one, const collision::BodyState& state) const;
  void approach(BodyMotion& one, const collision::BodyState& state);

  // simulation.cpp
  /// Resting contacts load the frame.
  void load();
  void break_generations();
  void begin_motion();
  void substep();
  void end_motion();
  void record(const std::vector<JointBreak>& breaks);

  // release.cpp: what left the frame becomes bodies.
  void release();
  void release(const Detached& part);
  // cut_in_two.cpp: the pieces of a post that buckled inside.
  void release_in_two(const Detached& part);
  [[nodiscard]] Body piece_of(MemberId member, int end, double cut) const;
  void check_momentum(const Body& body, const std::optional<Detached::Motion>& motion);
  void remove_body(collision::BodyId id, bool keep_weight);
  void keep_limit();

  // account.cpp
  void move();
  void account();
  void account_body(BodyMotion& one);
  void account_contacts();
  void watch_overlaps();
  [[nodiscard]] bool rests() const;
  void record_rest_and_end();
  void account_now();

  // save_and_restore.cpp
  void require_parts(const Snapshot::Action& action) const;
  [[nodiscard]] Building building_at_start() const;

  // host_contacts.cpp: bodies that the host owns.
  void strike_by_host();
  void strike_by_host(const HostContact& contact, Part part, HostImpulse& felt);
  void push_debris(const HostContact& contact, HostImpulse& felt);

  // queries.cpp
  [[nodiscard]] std::vector<Carrier> what_carries(const ContactPlace& place) const;

  // Small things.
  [[nodiscard]] bool nothing_to_do() const;
  [[nodiscard]] bool finished() const;

  Scene scene;
  EventLog log;
  RunningSums sums;
  Debris debris;
  Hinges hinges;
  BreakablePanels panels;
  ToolActions tools;
  PieceViews views;
  BreakUp break_up;
  ReleaseImpulses release_impulses;
  StruckClocks struck;
  StandingFracture standing_fracture;
  StandingImpacts standing_impacts;
  BodyImpacts body_impacts;
  DebrisFracture debris_fracture;
  std::unique_ptr<MovingParts> moving_parts;
  std::vector<ContactRecord> contact_records;  ///< of the last collision step

  std::vector<Snapshot::Action> actions;              ///< all that was asked for so far
  std::map<JointId, JointCapacity> given_capacities;  ///< of joints that were given others, as the building had them
  std::vector<HostContact> touches;                   ///< to come in the next step
  std::vector<HostImpulse> host_impulses;
  bool was_at_rest = false, done_told = false;

  collision::OverlapWatch overlap_watch;
  BodyOverlaps overlaps;
};

}  // namespace topple::structure
