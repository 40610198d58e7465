#pragma once
// One run of a building as a person steers it: the simulation with the actions taken, so that it can be started again
// and the last action be taken back.
#include <cstdint>
#include <memory>
#include <vector>

#include "renderer/snapshot_taker.h"
#include "topple/structure/simulation.h"

namespace topple::viewer {

class Session {
 public:
  /// The scenario's end is put off: a person may act at any time. Throws as structure::Simulation does.
  Session(std::shared_ptr<const structure::Building> building, structure::Scenario scenario);

  void step();
  void apply(const structure::Tool& tool);
  /// Back to the beginning; actions are forgotten.
  void restart();
  /// Back to just before the last action, by running again what came before it (the same bits, as runs are
  /// deterministic). False when there was none.
  bool undo();

  [[nodiscard]] const structure::Building& building() const { return *building_; }
  [[nodiscard]] const structure::Scenario& scenario() const { return scenario_; }
  [[nodiscard]] const structure::Simulation& simulation() const { return *simulation_; }
  [[nodiscard]] std::shared_ptr<const Snapshot> snapshot();
  /// What the next snapshots hold beside poses and demands.
  void want(Wanted wanted) { taker_.want(wanted_ = wanted); }
  [[nodiscard]] std::size_t actions() const { return actions_.size(); }

 private:
  struct Action {
    std::int64_t step;
    structure::Tool tool;
  };
  void begin();
  std::shared_ptr<const structure::Building> building_;
  structure::Scenario scenario_;
  std::unique_ptr<structure::Simulation> simulation_;
  SnapshotTaker taker_;
  Wanted wanted_;
  std::vector<Action> actions_;
};

}  // namespace topple::viewer
