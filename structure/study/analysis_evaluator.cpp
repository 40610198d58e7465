// Samples of a model: one analysis each, in memory.
#include <algorithm>
#include <limits>
#include <optional>

#include "analysis/sample_analysis.h"
#include "model/own_mass.h"
#include "study/analysis_options.h"
#include "study/evaluators.h"

namespace topple::structure::study {

namespace {

double largest_use(const AnalysisResult& result) {
  double largest = 0;
  for (const CombinationResult& combination : result.combinations) {
    for (const Utilisation& used : combination.joints) largest = std::max(largest, used.value);
    for (const DesignResult& design : combination.designs)
      if (!design.governing.empty()) largest = std::max(largest, design.utilisation);
  }
  return largest;
}

/// The factor on the loads at which the first joint or member is used up, or the first combination buckles.
double reserve_factor(const AnalysisResult& result) {
  const double use = largest_use(result);
  double factor = use > 0 ? 1 / use : std::numeric_limits<double>::infinity();
  for (const CombinationResult& combination : result.combinations)
    if (!combination.buckling.empty()) factor = std::min(factor, combination.buckling.front().factor);
  return factor;
}

/// The worst joint after any of the losses; infinite where one leaves a mechanism.
double worst_loss_use(const LossResult& losses) {
  double worst = 0;
  for (const MemberLoss& loss : losses.losses)
    for (const LossState& state : loss.states)
      worst = std::max(worst, state.stands() ? state.utilisation.value : std::numeric_limits<double>::infinity());
  return worst;
}

double losses_survived(const LossResult& losses) {
  if (losses.losses.empty()) return no_value;
  const auto survived = std::count_if(losses.losses.begin(), losses.losses.end(), [](const MemberLoss& loss) {
    return std::all_of(loss.states.begin(), loss.states.end(), [](const LossState& state) { return state.survives(); });
  });
  return static_cast<double>(survived) / static_cast<double>(losses.losses.size());
}

double largest_drift(const AnalysisResult& result) {
  double drift = 0;
  for (const CombinationResult& combination : result.combinations)
    for (const StoreyResult& storey : combination.storeys) drift = std::max(drift, storey.drift);
  return drift;
}

class AnalysisEvaluator : public SampleEvaluator {
 public:
  explicit AnalysisEvaluator(std::shared_ptr<const StudyBase> base) : base_(base), of_sample_(std::move(base)) {}

  void evaluate(Sample& sample) override {
    of_sample_.apply(sample.inputs);
    const Building& building = of_sample_.building();
    if (!of_sample_.same_building() || !result_) analyse_building();
    AnalysisOfSample asked = *asked_;
    AnalysisResult& result = *result_;
    lose(asked, result);
    std::optional<formats::JsonDocument> results;
    for (const Recorded& recorded : base_->study.record) {
      if (recorded.from == Recorded::From::results && !results)
        results = formats::JsonDocument::from_text(results_json(building, asked.request, result, {}), "results.json");
      sample.outputs.push_back(recorded.from == Recorded::From::results ? number_at(*results, recorded)
                                                                        : ready(recorded.pointer, result));
    }
    std::vector<bool> bits(building.members.size() + building.panels.size() + building.joints.size());
    for (const CombinationResult& combination : result.combinations)
      for (std::size_t j = 0; j < combination.joints.size(); ++j)
        if (combination.joints[j].value > 1) bits[building.members.size() + building.panels.size() + j] = true;
    sample.parts = parts_text(bits);
  }

 private:
  /// What all samples that differ in what is lost share.
  void analyse_building() {
    const Building& building = of_sample_.building();
    result_.reset();
    sweep_.reset();
    if (!asked_ || !of_sample_.same_names()) asked_ = analysis_of(base_->study, building);
    AnalysisResult result = whole(*asked_) ? analyse_with(kept_, building, asked_->request)
                                           : analyse_briefly(kept_, building, asked_->request);
    if (asked_->code) check_design(building, *asked_->code, usual_drift_limit, result);
    losses_ = result.losses.losses;
    result_ = std::move(result);
  }

  /// The sample's own loss, behind those that the options ask for.
  void lose(AnalysisOfSample& asked, AnalysisResult& result) {
    result.losses.losses = losses_;
    if (of_sample_.lost().empty()) return;
    LossRequest& losses = asked.request.losses;
    if (!sweep_) {
      LossRequest any{{}, of_sample_.may_be_lost(), losses.sudden, {}};
      sweep_.emplace(of_sample_.building(), asked.request.combinations, std::move(any), asked.request.solver);
    }
    for (const MemberId member : of_sample_.lost()) {
      losses.each.push_back(member);
      result.losses.losses.push_back(sweep_->lose(member));
    }
  }

  /// What is recorded needs more than the ends of members.
  [[nodiscard]] bool whole(const AnalysisOfSample& asked) const {
    return asked.code || std::any_of(base_->study.record.begin(), base_->study.record.end(), [](const Recorded& r) {
             return r.from == Recorded::From::results || r.pointer == "largest_displacement";
           });
  }

  [[nodiscard]] double ready(const std::string& name, const AnalysisResult& result) const {
    if (name == "largest_use") return largest_use(result);
    if (name == "reserve_factor") return reserve_factor(result);
    if (name == "worst_loss_use") return worst_loss_use(result.losses);
    if (name == "losses_survived") return losses_survived(result.losses);
    if (name == "largest_drift") return largest_drift(result);
    if (name == "weight") return own_mass(of_sample_.building());
    double largest = 0;  // largest_displacement
    for (const CombinationResult& combination : result.combinations)
      largest = std::max(largest, combination.largest.value);
    return largest / of_sample_.building().units.length;
  }

  std::shared_ptr<const StudyBase> base_;
  BaseOfSample of_sample_;
  solver::KeptEquations kept_;
  std::optional<AnalysisOfSample> asked_;  ///< by the options
  // Of the building as it is.
  std::optional<AnalysisResult> result_;
  std::vector<MemberLoss> losses_;  ///< that the options ask for
  std::optional<LossSweep> sweep_;
};

}  // namespace

std::unique_ptr<SampleEvaluator> analysis_evaluator(std::shared_ptr<const StudyBase> base) {
  return std::make_unique<AnalysisEvaluator>(std::move(base));
}

}  // namespace topple::structure::study
