#pragma once
// What is written of a collapse: events.jsonl, summary.json, standing.json (docs/results-format.md has the keys), and
// the summary that a person reads. Everything but wall times is the same in every run.
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "topple/structure/simulation.h"

namespace topple::structure {

/// Wall times of the steps in which something was done, by stage.
class StepTimes {
 public:
  /// Call after each step(). Steps that were passed over idle are left out.
  void add(const Simulation& simulation);

  /// Milliseconds.
  struct Percentiles {
    double mean = 0;  ///< of all steps
    double p50 = 0;   ///< median
    double p95 = 0;   ///< 95 % took no longer
    double p99 = 0;   ///< 99 % took no longer
    double max = 0;   ///< of the longest step
  };
  /// Of whole steps, ms.
  [[nodiscard]] Percentiles whole() const;
  /// Of steps less the time within the collision engine, ms.
  [[nodiscard]] Percentiles without_collision_engine() const;
  /// ms, in the order of stage_names.
  [[nodiscard]] std::array<double, 6> mean_by_stage() const;
  /// ms within the collision engine.
  [[nodiscard]] double mean_collision_engine() const;
  /// How many steps were added.
  [[nodiscard]] std::size_t steps() const { return whole_.size(); }

 private:
  std::vector<double> whole_, own_;
  std::array<double, 6> stages_{};
  double engine_ = 0;
};

/// How many parts are down, bodies lie about and segments stand.
struct CollapseCounts {
  std::size_t joints_broken = 0;      ///< of members and panels
  std::size_t members_down = 0;       ///< no longer part of what stands
  std::size_t panels_down = 0;        ///< no longer part of what stands
  std::size_t bodies = 0;             ///< moving pieces
  std::size_t standing_segments = 0;  ///< connected parts that reach a support
};
[[nodiscard]] CollapseCounts collapse_counts(const Simulation& simulation);

/// The ledger's energies in J by the names that summary.json gives them, the residual last.
[[nodiscard]] std::vector<std::pair<const char*, double>> ledger_entries(const Ledger& ledger);

/// One line of events.jsonl, without the line's end.
[[nodiscard]] std::string event_line(const Building& building, const SimulationEvent& event);
/// `roof_sag`: StandingFrame::roof_sag() before the first step, m.
[[nodiscard]] std::string summary_json(const Simulation& simulation, const StepTimes& times, double roof_sag);
/// What stands at the end: displacements, joint demands and each joint's largest utilisation over the run.
[[nodiscard]] std::string standing_json(const Simulation& simulation);
/// What a person reads: what broke, what fell, how long it took, the ledger.
[[nodiscard]] std::string collapse_text(const Simulation& simulation, const StepTimes& times);

/// Writes the three files; each appears whole or not at all. Throws std::runtime_error naming a file that cannot be
/// written.
void write_collapse(const std::filesystem::path& folder, const Simulation& simulation, const StepTimes& times,
                    double roof_sag);

}  // namespace topple::structure
