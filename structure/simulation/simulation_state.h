#pragma once
// What a Simulation is made of, and how the stages of a step go through its parts. Each part has a file of its own.
#include <memory>
#include <vector>

#include "simulation/debris/moving_parts.h"
#include "simulation/stage_parts.h"
#include "topple/solver/kept_memory.h"
#include "topple/structure/simulation.h"

namespace topple::structure {

struct Simulation::State : StageParts {
  State(Building the_building, Scenario the_scenario, SimulationOptions the_options);
  ~State();

  // Stages of a step.
  /// What awake bodies will touch in this step; where it is taken in substeps, in the first of them.
  [[nodiscard]] std::vector<collision::Contact> sweep_step();
  [[nodiscard]] std::vector<collision::Contact> sweep_bodies(double dt);
  /// Resting contacts load the frame.
  void load();
  /// What meets in the next `dt`.
  void strike(const std::vector<collision::Contact>& contacts, double dt);
  void break_generations();
  void begin_motion();
  void let_broken_go();
  void substep();
  void let_holds_change();
  void strike_between(double dt);
  void strike_on(std::vector<collision::Contact> contacts, double dt);
  void strike_released(std::int64_t newest);
  void end_motion();
  void move();
  void account();
  void record(const std::vector<JointBreak>& breaks);

  std::unique_ptr<MovingParts> moving_parts;
  /// s
  [[nodiscard]] double first_substep() const { return scene.scenario.step / scene.frame->substeps(); }

  solver::KeptMemory kept_memory;  ///< factors follow each other while a frame breaks

  // Of the step that runs.
  bool in_substeps = false;  ///< what stands moves, or is struck
  int substeps_left = 0;
};

}  // namespace topple::structure
