#pragma once
// Tools: what a scenario's events or a person do to the building, at the beginning of a step.
#include <map>
#include <string>
#include <vector>

#include "simulation/accounts/event_log.h"
#include "simulation/accounts/running_sums.h"
#include "simulation/debris/debris.h"

namespace topple::structure {

class ToolActions {
 public:
  /// All of it must outlive this.
  ToolActions(Scene& scene, EventLog& log, RunningSums& sums, Debris& debris);

  /// A person's tool, for the next step.
  void request(const Tool& tool) { asked_.push_back(tool); }
  [[nodiscard]] bool asked() const { return !asked_.empty(); }
  /// When the next event or stage acts, s; unlimited when none is to come.
  [[nodiscard]] double next_instant() const;
  /// All that acts in this step.
  void use();

  template <class Archive>
  void serialize(Archive& archive) {
    auto& [scene, log, sums, debris, asked, next_event, used_at, weakenings, stiffness_factors, launched] = *this;
    archive(asked, next_event, weakenings, stiffness_factors, launched);  // `used_at` is of the step that runs
  }

 private:
  /// What loses strength and stiffness over time, stage by stage.
  struct Weakening {
    WeakenTool tool;
    double begin = 0;
    int stage = 0;  ///< stages that have come
    [[nodiscard]] bool over() const { return stage == tool.stages; }
    [[nodiscard]] double next() const { return begin + tool.over * (stage + 1) / tool.stages; }
    /// Factor after some stages, `last` being the one after all of them.
    [[nodiscard]] double after(int stages, double last) const { return 1 + (last - 1) * stages / tool.stages; }
  };
  template <class Archive>
  friend void serialize(Archive& archive, Weakening& weakening) {
    auto& [tool, begin, stage] = weakening;
    archive(tool, begin, stage);
  }
  void utilisation_at(double instant, const Tool& tool);
  void use(const Projectile& projectile);
  void use(const WreckingBall& ball);
  void use(const CutTool& cut);
  void use(const RemoveTool& remove);
  void use(const ChargeTool& charge);
  void use(const WeakenTool& tool);
  void use(const GravityTool& tool);
  void use(const LoadTool& load);
  collision::BodyId launch(const std::string& kind, const Vec3& from, double mass, double radius, const Vec3& velocity);
  void use_stages();
  void use_stage(Weakening& weakening);
  void weaken(JointId joint, double change);

  Scene& scene_;
  EventLog& log_;
  RunningSums& sums_;
  Debris& debris_;
  std::vector<Tool> asked_;                ///< by a person, for the next step
  std::size_t next_event_ = 0;             ///< of the scenario
  double used_at_ = 0;                     ///< the instant of the tool that acts
  std::vector<Weakening> weakenings_;      ///< those with stages to come
  std::vector<double> stiffness_factors_;  ///< per member
  std::map<std::string, int> launched_;    ///< balls by kind
};

}  // namespace topple::structure
