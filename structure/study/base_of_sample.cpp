// One sample's building and scenario.
#include <algorithm>
#include <array>
#include <stdexcept>

#include "formats/documents.h"
#include "study/study_base.h"
#include "study/study_value.h"
#include "topple/structure/formats/files.h"

namespace topple::structure::study {

namespace {

/// No number there makes, joins or names a part, as those of a generated building and of nodes do.
bool names_nothing(const std::string& pointer) {
  constexpr std::array<std::string_view, 8> tables{"/materials/", "/sections/", "/joints/",       "/supports/",
                                                   "/masses/",    "/loads/",    "/combinations/", "/gravity"};
  return std::any_of(tables.begin(), tables.end(),
                     [&](std::string_view table) { return std::string_view(pointer).starts_with(table); });
}

std::string unquoted(const StudyValue& value) { return JsonTree::parse(value.json).text(); }

}  // namespace

BaseOfSample::BaseOfSample(std::shared_ptr<const StudyBase> base)
    : base_(std::move(base)), model_(base_->model_text, base_->study.model.filename().string()) {
  const bool of_scenario = base_->study.base == Study::Base::scenario;
  if (of_scenario)
    scenario_document_ =
        std::make_unique<VariedDocument>(base_->scenario_text, base_->study.scenario.filename().string());
  for (const Effect& effect : base_->effects) {
    if (effect.variation.target != Variation::Target::pointer) continue;
    if (effect.variation.of_model) {
      model_.add_target(effect.variation);
      model_targets_.push_back(effect.first);
    } else {
      scenario_document_->add_target(effect.variation);
      scenario_targets_.push_back(effect.first);
    }
  }
  const std::vector<std::string>& changed = model_.pointers();
  same_names_ = !of_scenario && model_.only_numbers() && std::all_of(changed.begin(), changed.end(), names_nothing);
  const auto purpose = of_scenario ? Purpose::demolish : Purpose::analyse;
  if (!model_.varies()) as_read_ = formats::read_model_document(model_.unchanged(), base_->study.model, purpose);
}

void BaseOfSample::read(const std::vector<StudyValue>& inputs) {
  const auto values = [&](const std::vector<std::size_t>& targets) {
    std::vector<const StudyValue*> all;
    for (const std::size_t variable : targets) all.push_back(&inputs[variable]);
    return all;
  };
  const bool of_scenario = scenario_document_ != nullptr;
  const auto purpose = of_scenario ? Purpose::demolish : Purpose::analyse;
  building_ = model_.varies()
                  ? formats::read_model_document(model_.with(values(model_targets_)), base_->study.model, purpose)
                  : as_read_;
  if (of_scenario) {
    auto both =
        formats::read_scenario_document(scenario_document_->with(values(scenario_targets_)), std::move(building_));
    building_ = std::move(both.first);
    scenario_ = std::move(both.second);
  }
}

std::vector<std::string> BaseOfSample::beside_losses(const std::vector<StudyValue>& inputs) const {
  std::vector<std::string> texts;
  for (const Effect& effect : base_->effects)
    for (std::size_t v = 0; v < effect.count && effect.variation.target != Variation::Target::loss; ++v)
      texts.push_back(text_of(inputs[effect.first + v]));
  return texts;
}

std::vector<MemberId> BaseOfSample::may_be_lost() const {
  std::vector<MemberId> members;
  for (const Effect& effect : base_->effects)
    if (effect.variation.target == Variation::Target::loss)
      for (const std::string& name : effect.names[0])
        if (const auto member = names_->member(name)) members.push_back(*member);
  return members;
}

void BaseOfSample::apply(const std::vector<StudyValue>& inputs) {
  lost_.clear();
  charges_ = 0;
  // A scenario is used up by its run.
  std::optional<std::vector<std::string>> made_with;
  if (!scenario_document_) made_with = beside_losses(inputs);
  same_building_ = made_with && applied_ == made_with;
  if (same_building_) {
    for (const Effect& effect : base_->effects)
      if (effect.variation.target == Variation::Target::loss) lose(effect, inputs[effect.first]);
    return;
  }
  applied_.reset();
  read(inputs);
  const bool by_name = std::any_of(base_->effects.begin(), base_->effects.end(), [](const Effect& effect) {
    return effect.variation.target != Variation::Target::pointer;
  });
  if (by_name && (!names_ || !same_names_)) names_ = std::make_unique<NameIndex>(building_);
  for (const Effect& effect : base_->effects) {
    if (effect.variation.target == Variation::Target::joints) strengthen(effect, inputs);
    if (effect.variation.target == Variation::Target::loss) lose(effect, inputs[effect.first]);
    if (effect.variation.target == Variation::Target::charges) charge(effect, inputs);
  }
  std::stable_sort(scenario_.events.begin(), scenario_.events.end(),
                   [](const Event& a, const Event& b) { return a.at < b.at; });
  applied_ = std::move(made_with);
}

void BaseOfSample::strengthen(const Effect& effect, const std::vector<StudyValue>& inputs) {
  for (std::size_t v = 0; v < effect.count; ++v) {
    const double factor = inputs[effect.first + v].number;
    require_in({1e-9, 1e9}, factor, effect.variation.name);
    for (const std::string& name : effect.names[v]) {
      const auto joint = names_->joint(name);
      if (!joint) throw std::runtime_error("there is no joint " + name + " in this sample");
      for (double& value : building_.joints[static_cast<std::size_t>(joint->index)].capacity.value) value *= factor;
    }
  }
}

std::vector<MemberId> BaseOfSample::pieces_of(const std::string& member) const {
  const auto first = names_->member(member);
  if (!first) throw std::runtime_error("there is no member " + member + " in this sample");
  std::vector<MemberId> pieces{*first};
  // A member that the scenario cuts inside is in pieces (divide_member.h).
  if (names_->node(member + "/cut-1"))
    for (int n = 2; const auto piece = names_->member(member + "/" + std::to_string(n)); ++n) pieces.push_back(*piece);
  return pieces;
}

void BaseOfSample::lose(const Effect&, const StudyValue& name) {
  lost_ = pieces_of(unquoted(name));
  RemoveTool remove;
  remove.members = lost_;
  if (scenario_document_) scenario_.events.push_back({0, std::move(remove)});
}

void BaseOfSample::charge(const Effect& effect, const std::vector<StudyValue>& inputs) {
  const std::size_t stride = effect.variation.used ? 2 : 1;
  for (std::size_t c = 0; c < effect.names.size(); ++c) {
    const std::size_t v = effect.first + stride * c;
    if (effect.variation.used && inputs[v + 1].json != "true") continue;
    RemoveTool remove;
    for (const std::string& name : effect.names[c]) {
      const std::vector<MemberId> pieces = pieces_of(name);
      remove.members.insert(remove.members.end(), pieces.begin(), pieces.end());
    }
    scenario_.events.push_back(
        {require_in(ranges::instant, inputs[v].number, effect.variation.name), std::move(remove)});
    charges_ += static_cast<int>(effect.names[c].size());
  }
}

}  // namespace topple::structure::study
