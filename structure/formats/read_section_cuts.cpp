// Cuts through a structure: planes by name, and what counts of all that they pass.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "formats/json/json_document.h"
#include "formats/model_files.h"
#include "formats/model_reader.h"
#include "topple/structure/analysis.h"
#include "topple/structure/modelling_checks.h"
#include "topple/structure/parse_cuts.h"

namespace topple::structure {

namespace {

using formats::JsonValue;

Vec3 direction(const JsonValue& value) {
  const Vec3 given = value.numbers<Vec3>();
  constexpr double least = 1e-100;
  if (!(given.norm() > least)) value.refuse("a direction: not all three are 0");
  return given.normalized();
}

/// Rows: normal, along, across. Along lies as near to what is given as the plane allows; else it is horizontal, and x
/// where the normal is upright.
Mat3 axes_of(const JsonValue& cut) {
  const Vec3 normal = direction(cut.require("normal"));
  constexpr double parallel = 1e-6;
  Vec3 along = Vec3::UnitZ().cross(normal);
  if (along.norm() < parallel) along = Vec3::UnitX();
  if (const auto given = cut.find("along")) along = direction(*given);
  along -= normal.dot(along) * normal;
  if (along.norm() < parallel) cut.require("along").refuse("a direction that is not the normal's");
  along.normalize();
  Mat3 axes;
  axes << normal.transpose(), along.transpose(), normal.cross(along).transpose();
  return axes;
}

template <class Id>
void put_in_order(std::vector<Id>& ids) {
  const auto before = [](Id a, Id b) { return a.index < b.index; };
  std::sort(ids.begin(), ids.end(), before);
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
}

/// Members and panels by name, pattern or group.
void read_parts(const JsonValue& list, const Building& building, const NameIndex& names, SectionCut& cut) {
  cut.everything = false;
  list.expect_array(1, ~std::size_t{0});
  for (const JsonValue item : list) {
    const std::string name(item.text());
    std::vector<MemberId> members = names.members_matching(name);
    std::vector<PanelId> panels = names.panels_matching(name);
    if (const NameIndex::Group* group = names.group(name); group != nullptr && members.empty() && panels.empty()) {
      members = group->members;
      panels = group->panels;
    }
    if (members.empty() && panels.empty()) {
      std::vector<std::string> known;
      for (const Member& member : building.members) known.push_back(member.name);
      for (const Panel& panel : building.panels) known.push_back(panel.name);
      item.fail("no member, panel or group " + name + did_you_mean(name, known));
    }
    cut.members.insert(cut.members.end(), members.begin(), members.end());
    cut.panels.insert(cut.panels.end(), panels.begin(), panels.end());
  }
  put_in_order(cut.members);
  put_in_order(cut.panels);
}

}  // namespace

std::vector<SectionCut> read_section_cuts(const std::string& path, const Building& building) {
  return parse_section_cuts(formats::whole_text(path), path, building);
}

std::vector<SectionCut> parse_section_cuts(std::string_view text, const std::string& name, const Building& building) {
  const auto document = formats::JsonDocument::from_text(std::string(text), name);
  const JsonValue root = document.root();
  if (!root.is_object()) root.refuse("an object");
  root.only({"cuts"});
  const JsonValue list = root.require("cuts");
  list.expect_object();
  if (list.size() == 0) list.refuse("one cut at least");
  const NameIndex names(building);
  std::vector<SectionCut> cuts;
  for (const JsonValue value : list) {
    value.only({"at", "normal", "along", "parts"});
    SectionCut& cut = cuts.emplace_back();
    cut.name = value.key();
    cut.at = formats::read_point(value.require("at"), building.units.length);
    cut.axes = axes_of(value);
    if (const auto parts = value.find("parts")) read_parts(*parts, building, names, cut);
  }
  return cuts;
}

}  // namespace topple::structure
