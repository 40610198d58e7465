#pragma once
// What a Simulation is made of, and how the stages of a step go through its parts. Each part has a file of its own.
#include "simulation/accounts/body_account.h"
#include "simulation/accounts/overlap_log.h"
#include "simulation/accounts/piece_views.h"
#include "simulation/action_record.h"
#include "simulation/debris/hinges.h"
#include "simulation/debris/moving_parts.h"
#include "simulation/debris/release.h"
#include "simulation/run_progress.h"
#include "simulation/sweep.h"

namespace topple::structure {

struct Simulation::State {
  State(Building the_building, Scenario the_scenario, SimulationOptions the_options);
  ~State();

  // Stages of a step.
  /// What awake bodies will touch in this step.
  [[nodiscard]] std::vector<collision::Contact> sense();
  /// Resting contacts load the frame.
  void load();
  void strike(const std::vector<collision::Contact>& contacts);
  void break_generations();
  void begin_motion();
  void substep();
  void end_motion();
  void move();
  void account();
  void record(const std::vector<JointBreak>& breaks);

  Scene scene;
  EventLog log;
  RunningSums sums;
  Debris debris;
  Hinges hinges;
  BreakablePanels panels;
  ToolActions tools;
  PieceViews views;
  BreakUp break_up;
  Sweep sweep;
  ReleaseImpulses release_impulses;
  StruckClocks struck;
  StandingFracture standing_fracture;
  StandingImpacts standing_impacts;
  BodyImpacts body_impacts;
  HostContacts hosts;
  DebrisFracture debris_fracture;
  Release release;
  std::unique_ptr<MovingParts> moving_parts;
  BodyAccount bodies;
  OverlapLog overlaps;
  RunProgress progress;
  ActionRecord actions;
};

}  // namespace topple::structure
