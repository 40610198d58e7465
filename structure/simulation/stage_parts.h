#pragma once
// The parts that the stages of a step go through, each with what it works on. Tests of single stages have them as a
// simulation has.
#include "simulation/accounts/body_account.h"
#include "simulation/accounts/overlap_log.h"
#include "simulation/accounts/piece_views.h"
#include "simulation/action_record.h"
#include "simulation/debris/hinges.h"
#include "simulation/debris/release.h"
#include "simulation/run_progress.h"
#include "simulation/sweep.h"

namespace topple::structure {

struct StageParts {
  StageParts(Building building, Scenario scenario, SimulationOptions options);
  StageParts(const StageParts&) = delete;
  StageParts& operator=(const StageParts&) = delete;

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
  BodyAccount bodies;
  OverlapLog overlaps;
  RunProgress progress;
  ActionRecord actions;
};

/// After `actions` and `scene`, with its frame and its world: what bodies are made of and the building as it is are
/// there then. `struck` is of the step that runs.
template <class Archive>
void serialize(Archive& archive, StageParts& parts) {
  auto& [scene, log, sums, debris, hinges, panels, tools, views, break_up, sweep, release_impulses, struck,
         standing_fracture, standing_impacts, body_impacts, hosts, debris_fracture, release, bodies, overlaps, progress,
         actions] = parts;
  archive(log, sums, debris, hinges, panels, tools, views, break_up, sweep, release_impulses, standing_fracture,
          standing_impacts, body_impacts, hosts, debris_fracture, release, bodies, overlaps, progress);
}

}  // namespace topple::structure
