// Cuts through a structure: planes by name, and what counts of all that they pass.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "formats/documents.h"
#include "formats/model_files.h"
#include "formats/model_forms.h"
#include "formats/model_reader.h"
#include "formats/section_cuts.h"
#include "topple/structure/analysis.h"
#include "topple/structure/formats/parse_cuts.h"
#include "topple/structure/modelling_checks.h"

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

/// A member that was divided by `connect` or --divide is its pieces together: M, M/2, M/3 ...
void add_pieces(const Building& building, const NameIndex& names, std::vector<MemberId>& members) {
  const std::vector<MemberId> first = members;
  for (const MemberId member : first)
    for (int piece = 2;; ++piece) {
      const auto next = names.member(building[member].name + "/" + std::to_string(piece));
      if (!next) break;
      members.push_back(*next);
    }
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
    add_pieces(building, names, members);
    cut.members.insert(cut.members.end(), members.begin(), members.end());
    cut.panels.insert(cut.panels.end(), panels.begin(), panels.end());
  }
  put_in_order(cut.members);
  put_in_order(cut.panels);
}

/// The `cuts` of a model's root object.
std::vector<SectionCut> cuts_of_model(const JsonValue& root, const Building& building) {
  if (!root.is_object()) return {};
  const auto list = root.find("cuts");
  return list ? formats::section_cuts(*list, building) : std::vector<SectionCut>{};
}

}  // namespace

std::vector<SectionCut> formats::section_cuts(const JsonValue& list, const Building& building) {
  list.expect_object();
  if (list.size() == 0) list.refuse("one cut at least");
  const NameIndex names(building);
  std::vector<SectionCut> cuts;
  for (const JsonValue value : list) {
    value.only({"at", "normal", "along", "parts"});
    SectionCut& cut = cuts.emplace_back();
    cut.name = value.key();
    cut.at = read_point(value.require("at"), building.units.length);
    cut.axes = axes_of(value);
    if (const auto parts = value.find("parts")) read_parts(*parts, building, names, cut);
  }
  return cuts;
}

std::vector<SectionCut> parse_model_cuts(std::string_view text, const std::string& name, const Building& building) {
  // Most models have none: their text is not read twice. A key may be written with escapes.
  if (text.find("cuts\"") == std::string_view::npos && text.find("\\u") == std::string_view::npos) return {};
  return cuts_of_model(formats::JsonDocument::from_text(std::string(text), name).root(), building);
}

std::vector<SectionCut> read_model_cuts(const std::filesystem::path& file, const Building& building) {
  if (std::error_code ignored; std::filesystem::is_directory(file, ignored)) {
    if (!std::filesystem::exists(file / "cuts.csv", ignored)) return {};
    ModelOfTables model = model_of_tables(formats::read_tables(file), file.string());
    const auto document = formats::JsonDocument::from_text(model.json, file.string(), {}, std::move(model.places));
    return cuts_of_model(document.root(), building);
  }
  if (formats::ending_of(file) != ".json") return {};
  return parse_model_cuts(formats::whole_text(file), file.filename().string(), building);
}

std::vector<SectionCut> read_section_cuts(const std::string& path, const Building& building) {
  return parse_section_cuts(formats::whole_text(path), path, building);
}

std::vector<SectionCut> parse_section_cuts(std::string_view text, const std::string& name, const Building& building) {
  const auto document = formats::JsonDocument::from_text(std::string(text), name);
  const JsonValue root = document.root();
  if (!root.is_object()) root.refuse("an object");
  root.only({"cuts"});
  return formats::section_cuts(root.require("cuts"), building);
}

}  // namespace topple::structure
