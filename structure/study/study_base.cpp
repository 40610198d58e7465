// What a study of files varies, by name.
#include "study/study_base.h"

#include <algorithm>

#include "topple/structure/error.h"
#include "topple/structure/formats/convert.h"
#include "topple/structure/formats/files.h"
#include "topple/structure/formats/input_files.h"
#include "topple/structure/joint_tuning.h"

#include "formats/documents.h"

namespace topple::structure::study {

namespace {

std::vector<std::string> members_named(const NameIndex& names, const Building& building, const std::string& selector,
                                       const std::string& place) {
  std::vector<MemberId> found = names.members_matching(selector);
  if (const NameIndex::Group* group = names.group(selector); group != nullptr && found.empty()) found = group->members;
  if (found.empty())
    throw InputError(place + ": there is no member or group " + formats::in_quotes(selector) +
                     "; accepted: a group of members, a member's name or a pattern with *");
  std::vector<std::string> members;
  for (const MemberId id : found) members.push_back(building[id].name);
  return members;
}

StudyValue text_value(const std::string& text) {
  StudyValue value;
  value.json = JsonTree(text).dump();
  return value;
}

/// Entries as variables, in their order.
class Expansion {
 public:
  Expansion(StudyBase& base, const Building* building) : base_(base), building_(building) {
    if (building) names_ = std::make_unique<NameIndex>(*building);
  }

  void add(const Variation& variation) {
    Effect effect{variation, base_.variables.size(), 0, {}};
    switch (variation.target) {
      case Variation::Target::pointer:
        base_.variables.push_back({variation.name, variation.distribution});
        break;
      case Variation::Target::joints:
        joints(effect);
        break;
      case Variation::Target::loss:
        losses(effect);
        break;
      case Variation::Target::charges:
        charges(effect);
        break;
    }
    effect.count = base_.variables.size() - effect.first;
    base_.effects.push_back(std::move(effect));
  }

 private:
  void joints(Effect& effect) {
    const Variation& variation = effect.variation;
    std::vector<JointId> found;
    try {
      found = joints_of(*building_, *names_, variation.selector);
    } catch (const InputError& error) {
      throw InputError(variation.place + ".joints: " + error.what());
    }
    std::vector<std::string> all;
    for (const JointId id : found)
      if ((*building_)[id].capacity.breakable) all.push_back((*building_)[id].name);
    if (all.empty())
      throw InputError(variation.place + ".joints: none of " + formats::in_quotes(variation.selector) +
                       " has a capacity; accepted: joints that can break");
    if (!variation.each) {
      base_.variables.push_back({variation.name, variation.distribution});
      effect.names.push_back(std::move(all));
      return;
    }
    for (const std::string& name : all) {
      base_.variables.push_back({variation.name + " " + name, variation.distribution});
      effect.names.push_back({name});
    }
  }

  void losses(Effect& effect) {
    Distribution members = effect.variation.distribution;
    effect.names.push_back(
        members_named(*names_, *building_, effect.variation.selector, effect.variation.place + ".lose_each"));
    for (const std::string& name : effect.names[0]) members.values.push_back(text_value(name));
    base_.variables.push_back({effect.variation.name, std::move(members)});
  }

  void charges(Effect& effect) {
    const Variation& variation = effect.variation;
    const auto add = [&](const std::string& name, std::vector<std::string> members) {
      base_.variables.push_back({name, variation.distribution});
      if (variation.used) base_.variables.push_back({name + " used", *variation.used});
      effect.names.push_back(std::move(members));
    };
    std::vector<std::string> all;
    for (const std::string& selector : variation.charges)
      for (std::string& name : members_named(*names_, *building_, selector, variation.place + ".charges"))
        if (std::find(all.begin(), all.end(), name) == all.end()) all.push_back(std::move(name));
    if (!variation.each) return add(variation.name, std::move(all));
    for (const std::string& name : all) add(variation.name + " " + name, {name});
  }

  StudyBase& base_;
  const Building* building_;
  std::unique_ptr<NameIndex> names_;
};

CorrelatedGroup group_of(const StudyBase& base, const Study::Group& group) {
  CorrelatedGroup made;
  std::size_t entries = 0;
  for (const std::string& name : group.of) {
    const Effect* effect = base.effect(name);
    if (effect == nullptr)
      throw InputError(group.place + ".of: " + formats::in_quotes(name) + " does not vary by chance");
    for (std::size_t v = 0; v < effect->count; ++v) {
      if (base.variables[effect->first + v].distribution.kind == Distribution::Kind::grid)
        throw InputError(group.place + ".of: " + formats::in_quotes(name) +
                         " is a grid, which goes through all its values; accepted: what is drawn by chance");
      made.variables.push_back(effect->first + v);
    }
    ++entries;
  }
  const std::size_t n = made.variables.size();
  if (!group.matrix.empty() && entries != n)
    throw InputError(group.place + ".correlation: a matrix for entries of " + std::to_string(n) +
                     " variables; accepted there: one number, the same between any two");
  made.correlation = group.matrix;
  if (made.correlation.empty()) {
    made.correlation.assign(n * n, group.alike);
    for (std::size_t i = 0; i < n; ++i) made.correlation[i * n + i] = 1;
  }
  return made;
}

}  // namespace

const Effect* StudyBase::effect(std::string_view name) const {
  for (const Effect& one : effects)
    if (one.variation.name == name) return &one;
  return nullptr;
}

std::shared_ptr<const StudyBase> make_base(const Study& given, const std::vector<Variation>& variations) {
  auto base = std::make_shared<StudyBase>();
  base->study = given;
  Study& study = base->study;
  Building building;
  if (study.base == Study::Base::scenario) {
    base->scenario_text = read_whole_file(study.scenario);
    const auto document = formats::JsonDocument::from_text(base->scenario_text, study.scenario.filename().string());
    study.model = formats::model_of_scenario(document, study.scenario.parent_path());
    building = read_scenario(study.scenario).first;
  } else if (study.base == Study::Base::model) {
    building = read_model(study.model);
  }
  // Whatever its form; JSON as it stands.
  if (!study.model.empty()) base->model_text = convert_model(study.model, ModelForm::json).files.at(0).second;
  Expansion expansion(*base, study.base == Study::Base::none ? nullptr : &building);
  for (const Variation& variation : variations) expansion.add(variation);
  for (const Study::Group& group : study.groups) base->groups.push_back(group_of(*base, group));
  return base;
}

}  // namespace topple::structure::study
