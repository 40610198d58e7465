// Samples of a scenario: one collapse each, in memory.
#include <algorithm>

#include "model/index_of.h"
#include "model/own_mass.h"
#include "model/panel_area.h"
#include "study/debris_field.h"
#include "study/evaluators.h"
#include "topple/structure/collapse_report.h"

namespace topple::structure::study {

namespace {

/// How many members are down at which time.
class DownHistory {
 public:
  void record(const Simulation& simulation) {
    if (simulation.events().size() == events_) return;
    events_ = simulation.events().size();
    const std::size_t down = collapse_counts(simulation).members_down;
    if (steps_.empty() || steps_.back().second != down) steps_.emplace_back(simulation.time(), down);
  }
  /// When half of the members that are down in the end were down; NaN: none is.
  [[nodiscard]] double half() const {
    if (steps_.empty() || steps_.back().second == 0) return no_value;
    for (const auto& [time, down] : steps_)
      if (2 * down >= steps_.back().second) return time;
    return no_value;
  }

 private:
  std::size_t events_ = 0;
  std::vector<std::pair<double, std::size_t>> steps_;
};

struct Fallen {
  double floor_area = 0, mass = 0, all_mass = 0;
};

Fallen fallen_parts(const Simulation& simulation) {
  const Building& building = simulation.building();
  Fallen fallen;
  for (std::size_t m = 0; m < building.members.size(); ++m) {
    const double mass = own_mass(building, MemberId(m));
    fallen.all_mass += mass;
    if (!simulation.frame().stands(MemberId(m))) fallen.mass += mass;
  }
  for (std::size_t p = 0; p < building.panels.size(); ++p) {
    const double mass = own_mass(building, PanelId(p));
    fallen.all_mass += mass;
    if (simulation.frame().stands(PanelId(p))) continue;
    fallen.mass += mass;
    if (building.panels[p].kind == PanelKind::slab) fallen.floor_area += panel_area(building, building.panels[p], true);
  }
  return fallen;
}

double largest_standing_utilisation(const Simulation& simulation) {
  const Building& building = simulation.building();
  double largest = 0;
  for (std::size_t j = 0; j < building.joints.size(); ++j) {
    const Joint& joint = building.joints[j];
    const bool stands =
        joint.member.valid() ? simulation.frame().stands(joint.member) : simulation.frame().stands(joint.panel);
    if (joint.capacity.breakable && stands && simulation.frame().intact(JointId(j)))
      largest = std::max(largest, simulation.frame().utilisation(JointId(j)).value);
  }
  return largest;
}

std::string parts_of(const Simulation& simulation) {
  const Building& building = simulation.building();
  std::vector<bool> bits;
  for (std::size_t m = 0; m < building.members.size(); ++m) bits.push_back(!simulation.frame().stands(MemberId(m)));
  for (std::size_t p = 0; p < building.panels.size(); ++p) bits.push_back(!simulation.frame().stands(PanelId(p)));
  const std::size_t joints = bits.size();
  bits.resize(joints + building.joints.size());
  for (const SimulationEvent& event : simulation.events())
    if (event.kind == SimulationEvent::Kind::joint_broke && event.joint.joint.valid())
      bits[joints + index_of(event.joint.joint)] = true;
  return parts_text(bits);
}

class CollapseEvaluator : public SampleEvaluator {
 public:
  explicit CollapseEvaluator(std::shared_ptr<const StudyBase> base) : base_(base), of_sample_(std::move(base)) {}

  void evaluate(Sample& sample) override {
    of_sample_.apply(sample.inputs);
    Simulation simulation(of_sample_.building(), of_sample_.scenario(), {1, {}});
    const double sag = simulation.frame().roof_sag();
    StepTimes times;
    DownHistory history;
    while (!simulation.finished()) {
      simulation.skip_idle();
      simulation.step();
      times.add(simulation);
      history.record(simulation);
    }
    history.record(simulation);
    std::optional<formats::JsonDocument> summary;
    const DebrisField debris = debris_field(simulation);
    for (const Recorded& recorded : base_->study.record) {
      if (recorded.from == Recorded::From::summary && !summary)
        summary = formats::JsonDocument::from_text(summary_json(simulation, times, sag), "summary.json");
      sample.outputs.push_back(recorded.from == Recorded::From::summary
                                   ? number_at(*summary, recorded)
                                   : ready(recorded.pointer, simulation, history, debris));
    }
    sample.parts = parts_of(simulation);
  }

 private:
  [[nodiscard]] double ready(const std::string& name, const Simulation& simulation, const DownHistory& history,
                             const DebrisField& debris) const {
    if (name == "members_down") return static_cast<double>(collapse_counts(simulation).members_down);
    if (name == "panels_down") return static_cast<double>(collapse_counts(simulation).panels_down);
    if (name == "joints_broken") return static_cast<double>(collapse_counts(simulation).joints_broken);
    if (name == "floor_area_down") return fallen_parts(simulation).floor_area;
    if (name == "share_down") {
      const Fallen fallen = fallen_parts(simulation);
      return fallen.all_mass > 0 ? fallen.mass / fallen.all_mass : no_value;
    }
    if (name == "time_to_half_down") return history.half();
    if (name == "time_to_rest") return simulation.at_rest() ? simulation.time() : no_value;
    if (name == "debris_reach") return debris.reach;
    if (name == "debris_footprint") return debris.footprint;
    if (name == "height_left") return debris.height;
    if (name == "debris_footprint_95") return debris.footprint_95;
    if (name == "debris_outside") return debris.outside;
    if (name == "charges") return of_sample_.charges();
    if (name == "weight") return fallen_parts(simulation).all_mass;
    const double use = largest_standing_utilisation(simulation);
    if (name == "largest_use") return use;
    return use > 0 ? 1 / use : no_value;  // reserve_factor
  }

  std::shared_ptr<const StudyBase> base_;
  BaseOfSample of_sample_;
};

}  // namespace

std::unique_ptr<SampleEvaluator> collapse_evaluator(std::shared_ptr<const StudyBase> base) {
  return std::make_unique<CollapseEvaluator>(std::move(base));
}

}  // namespace topple::structure::study
