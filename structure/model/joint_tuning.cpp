#include "topple/structure/joint_tuning.h"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "formats/json/json_writer.h"
#include "model/index_of.h"
#include "topple/structure/error.h"
#include "topple/structure/formats/convert.h"

namespace topple::structure {
namespace {

std::size_t at(JointId joint) { return index_of(joint); }

void require_positive(const JointChange& change, const char* what, double value) {
  if (!(value > 0) || !std::isfinite(value))
    throw InputError("joints '" + change.joints + "': " + what + " must be a number above 0");
}

/// One object a line, commas between.
std::string json_of(const std::vector<JointChange>& changes) {
  std::string text;
  for (const JointChange& change : changes) {
    JsonWriter writer;
    writer.open('{').key("joints").value(change.joints);
    if (change.strength) writer.key("strength").value(*change.strength);
    for (std::size_t s = 0; s < 7; ++s)
      if (change.capacity[s]) writer.key(sense_names[s]).value(*change.capacity[s]);
    text += (text.empty() ? "\n    " : ",\n    ") + writer.close('}').release();
  }
  return text;
}

/// Where the array that belongs to a key of the outermost object ends (its bracket); npos when there is no such key.
std::size_t end_of_array(const std::string& json, const std::string& key) {
  int depth = 0;
  bool found = false;
  for (std::size_t i = 0; i < json.size(); ++i) {
    const char c = json[i];
    if (c == '"') {
      const std::size_t begin = ++i;
      while (json[i] != '"') i += json[i] == '\\' ? 2 : 1;
      found = found || (depth == 1 && json.compare(begin, i - begin, key) == 0 &&
                        json[json.find_first_not_of(" \t\r\n", i + 1)] == ':');
    } else if (c == '{' || c == '[') {
      ++depth;
    } else if ((c == '}' || c == ']') && --depth == 1 && found) {
      return i;
    }
  }
  return std::string::npos;
}

/// The last character before `at` that is no space.
std::size_t before(const std::string& json, std::size_t at) { return json.find_last_not_of(" \t\r\n", at - 1); }

}  // namespace

bool JointChange::empty() const {
  return !strength && std::none_of(capacity.begin(), capacity.end(), [](const auto& c) { return c.has_value(); });
}

std::vector<JointId> joints_of(const Building& building, const NameIndex& names, const std::string& selector) {
  std::vector<JointId> joints;
  if (const NameIndex::Group* group = names.group(selector)) {
    for (const MemberId member : group->members)
      for (int end = 0; end < 2; ++end) joints.push_back(building.joint(member, end));
    for (const PanelId panel : group->panels)
      for (int edge = 0; edge < 4; ++edge) joints.push_back(building.joint(panel, edge));
  } else {
    joints = names.joints_matching(selector);
  }
  if (joints.empty())
    throw InputError("joints '" + selector +
                     "': means no joint; accepted: a group (posts, beams, braces, slabs, walls or the model's own), a "
                     "joint's name such as " +
                     (building.joints.empty() ? "B1:1" : building.joints.front().name) + ", a pattern with *, or *");
  std::sort(joints.begin(), joints.end());
  return joints;
}

double capacity_unit(const Building& building, JointId joint, Sense sense) {
  const double force = building.units.force, length = building.units.length;
  const double unit = sense < Sense::torsion ? force : force * length;
  return building[joint].panel.valid() ? unit / length : unit;
}

JointTuning::JointTuning(const Building& building)
    : building_(building), names_(building), strength_(building.joints.size(), 1.0) {
  reset();
}

void JointTuning::reset() {
  base_.clear();
  for (const Joint& joint : building_.joints) base_.push_back(joint.capacity);
  std::fill(strength_.begin(), strength_.end(), 1.0);
  changes_.clear();
}

std::vector<JointId> JointTuning::apply(const JointChange& change) {
  if (change.strength) require_positive(change, "strength", *change.strength);
  for (std::size_t s = 0; s < 7; ++s)
    if (change.capacity[s]) require_positive(change, sense_names[s], *change.capacity[s]);
  std::vector<JointId> joints = joints_of(building_, names_, change.joints);
  for (const JointId joint : joints) {
    if (change.strength) strength_[at(joint)] = *change.strength;
    for (std::size_t s = 0; s < 7; ++s) {
      if (!change.capacity[s]) continue;
      base_[at(joint)].value[s] = *change.capacity[s] * capacity_unit(building_, joint, static_cast<Sense>(s));
      base_[at(joint)].breakable = true;
    }
  }
  keep(change);
  return joints;
}

void JointTuning::keep(const JointChange& change) {
  for (JointChange& earlier : changes_) {
    if (earlier.joints != change.joints) continue;
    if (change.strength) earlier.strength.reset();
    for (std::size_t s = 0; s < 7; ++s)
      if (change.capacity[s]) earlier.capacity[s].reset();
  }
  std::erase_if(changes_, [](const JointChange& one) { return one.empty(); });
  if (!change.empty()) changes_.push_back(change);
}

JointCapacity JointTuning::capacity(JointId joint) const {
  JointCapacity capacity = base_[at(joint)];
  for (double& value : capacity.value) value *= strength_[at(joint)];
  return capacity;
}

std::string model_with_changes(const std::filesystem::path& model, const std::vector<JointChange>& changes) {
  std::string text = convert_model(model, ModelForm::json).files.at(0).second;
  if (changes.empty()) return text;
  if (const std::size_t end = end_of_array(text, "joint_changes"); end != std::string::npos) {
    const std::size_t last = before(text, end);
    return text.substr(0, last + 1) + (text[last] == '[' ? "" : ",") + json_of(changes) + "\n  " + text.substr(end);
  }
  const std::size_t last = before(text, text.rfind('}'));
  return text.substr(0, last + 1) + ",\n  \"joint_changes\": [" + json_of(changes) + "\n  ]\n}\n";
}

}  // namespace topple::structure
