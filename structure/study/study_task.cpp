// From a study's file to samples.
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <limits>

#include "study/analysis_options.h"
#include "study/evaluators.h"
#include "study/study_tasks.h"
#include "study/study_value.h"
#include "topple/structure/error.h"
#include "topple/structure/formats/files.h"

namespace topple::structure {

namespace study {

namespace {

struct Ready {
  std::string_view name;
  bool of_scenario, of_model;
};
constexpr std::array<Ready, 20> all_ready{{{"members_down", true, false},     {"panels_down", true, false},
                                           {"joints_broken", true, false},    {"floor_area_down", true, false},
                                           {"share_down", true, false},       {"time_to_half_down", true, false},
                                           {"time_to_rest", true, false},     {"debris_reach", true, false},
                                           {"debris_footprint", true, false}, {"debris_footprint_95", true, false},
                                           {"height_left", true, false},      {"debris_outside", true, false},
                                           {"charges", true, false},          {"largest_use", true, true},
                                           {"reserve_factor", true, true},    {"weight", true, true},
                                           {"worst_loss_use", false, true},   {"losses_survived", false, true},
                                           {"largest_drift", false, true},    {"largest_displacement", false, true}}};

/// Nothing is run: a sample is its inputs.
class EmptyEvaluator : public SampleEvaluator {
 public:
  void evaluate(Sample&) override {}
};

std::uint64_t fingerprint_of(const StudyBase& base) {
  std::uint64_t hash = fnv1a(TOPPLE_VERSION);
  for (const std::string* text : {&base.study.text, &base.model_text, &base.scenario_text}) {
    hash = fnv1a(std::to_string(text->size()) + ":", hash);
    hash = fnv1a(*text, hash);
  }
  return hash;
}

/// What a sample would stumble over is told before the first.
void require_sound(const StudyBase& base) {
  const Study& study = base.study;
  for (const Recorded& recorded : study.record)
    if (recorded.from == Recorded::From::ready && !ready_for(recorded.pointer, study.base)) {
      std::string known;
      for (const Ready& ready : all_ready)
        if (ready_for(ready.name, study.base)) known += (known.empty() ? "" : ", ") + std::string(ready.name);
      throw InputError(recorded.place + ": " + recorded.pointer + " is no output of a " +
                       (study.base == Study::Base::model ? "model" : "scenario") + "; accepted: " + known);
    }
  if (study.base == Study::Base::none) return;
  const BaseOfSample of_sample(std::make_shared<StudyBase>(base));  // pointers lead somewhere
  if (study.base == Study::Base::model) (void)analysis_of(study, read_model(study.model));
}

}  // namespace

bool ready_for(std::string_view output, Study::Base base) {
  return std::any_of(all_ready.begin(), all_ready.end(), [&](const Ready& ready) {
    return ready.name == output && (base == Study::Base::scenario ? ready.of_scenario : ready.of_model);
  });
}

double number_at(const formats::JsonDocument& results, const Recorded& recorded) {
  const std::optional<formats::JsonValue> value = value_at(results, recorded.pointer);
  if (!value) throw std::runtime_error(recorded.name + ": there is nothing at " + recorded.pointer + " in the results");
  if (value->is_bool()) return value->boolean() ? 1 : 0;
  if (value->is_null()) return std::numeric_limits<double>::quiet_NaN();
  if (!value->is_number())
    throw std::runtime_error(recorded.name + ": " + value->found() + " stands at " + recorded.pointer +
                             "; accepted: a number");
  return value->number();
}

std::string parts_text(const std::vector<bool>& bits) {
  if (std::find(bits.begin(), bits.end(), true) == bits.end()) return {};
  std::string text;
  for (std::size_t i = 0; i < bits.size(); i += 4) {
    unsigned digit = 0;
    for (std::size_t b = 0; b < 4 && i + b < bits.size(); ++b) digit |= bits[i + b] ? 1U << b : 0;
    text += "0123456789abcdef"[digit];
  }
  return text;
}

}  // namespace study

std::span<const std::string_view> ready_outputs() {
  static const std::vector<std::string_view> names = [] {
    std::vector<std::string_view> all;
    for (const auto& ready : study::all_ready) all.push_back(ready.name);
    return all;
  }();
  return names;
}

namespace study {

std::shared_ptr<const StudyBase> sound_base(const Study& study, const std::vector<Variation>& variations) {
  const std::shared_ptr<const StudyBase> base = make_base(study, variations);
  require_sound(*base);
  return base;
}

void complete_task(StudyTask& task, std::shared_ptr<const StudyBase> base) {
  for (const Recorded& recorded : base->study.record) task.outputs.push_back(recorded.name);
  task.fingerprint = fingerprint_of(*base);
  task.apart = base->study.base == Study::Base::scenario;
  task.make_evaluator = [base]() -> std::unique_ptr<SampleEvaluator> {
    if (base->study.base == Study::Base::scenario) return collapse_evaluator(base);
    if (base->study.base == Study::Base::model) return analysis_evaluator(base);
    return std::make_unique<EmptyEvaluator>();
  };
}

}  // namespace study

StudyTask study_task(const Study& study) {
  const std::shared_ptr<const study::StudyBase> base = study::sound_base(study, study.vary);
  StudyTask task;
  try {
    task.sampler = StudySampler(base->variables, base->groups, study.sampling, study.samples, study.seed);
  } catch (const std::invalid_argument& error) {
    throw InputError(study.file + ": " + error.what());
  }
  study::complete_task(task, base);
  return task;
}

}  // namespace topple::structure
