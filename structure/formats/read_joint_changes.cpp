// `joint_changes`: capacities changed after the parts were made, in the order of the list.
#include "formats/model_reader.h"
#include "topple/structure/error.h"
#include "topple/structure/joint_tuning.h"

namespace topple::structure::formats {

namespace {

JointChange change_of(const JsonValue& value) {
  value.expect_object();
  value.only({"joints", "strength", "tension", "compression", "shear_y", "shear_z", "torsion", "moment_y", "moment_z"});
  JointChange change;
  change.joints = value.require("joints").text();
  if (const auto strength = value.find("strength")) change.strength = strength->positive();
  for (std::size_t s = 0; s < 7; ++s)
    if (const auto given = value.find(sense_names[s])) change.capacity[s] = given->positive();
  if (change.empty()) value.refuse("`strength` or the capacity in at least one of the seven senses");
  return change;
}

}  // namespace

void read_joint_changes(const JsonValue& root, ModelDraft& draft) {
  const auto list = root.find("joint_changes");
  if (!list) return;
  list->expect_array(0, std::size_t{1} << 20);
  JointTuning tuning(draft.building);
  for (const JsonValue item : *list) {
    try {
      (void)tuning.apply(change_of(item));
    } catch (const InputError& error) {
      const std::string what = error.what();
      if (what.starts_with("joints '")) item.fail(what);
      throw;
    }
  }
  std::vector<JointCapacity> changed;
  for (std::size_t j = 0; j < draft.building.joints.size(); ++j) changed.push_back(tuning.capacity(JointId(j)));
  for (std::size_t j = 0; j < changed.size(); ++j) draft.building.joints[j].capacity = changed[j];
}

}  // namespace topple::structure::formats
