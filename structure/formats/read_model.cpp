// A model from its file: the stages of reading in their order.
#include <algorithm>
#include <system_error>

#include "formats/documents.h"
#include "formats/frame3dd/frame3dd.h"
#include "formats/model_files.h"
#include "formats/model_forms.h"
#include "formats/model_reader.h"
#include "formats/read_meshes.h"
#include "formats/section_cuts.h"
#include "mesh/usual_mesh.h"
#include "model/connect_parts.h"
#include "topple/structure/error.h"
#include "topple/structure/formats/files.h"
#include "topple/structure/modelling_checks.h"
#include "visual/drawn_weight.h"

namespace topple::structure {

namespace {

using formats::JsonDocument;
using formats::JsonValue;

/// A model, and whether drawn meshes add to its weight.
struct ModelRead {
  Building building;
  bool drawn_weight = false;
};

/// `true`: within the usual tolerance; a number: within this length.
void read_connect(const JsonValue& root, formats::ModelDraft& draft) {
  const auto connect = root.find("connect");
  if (!connect) return;
  if (connect->is_number()) {
    (void)connect->positive();
    connect_parts(draft.building, formats::scaled(*connect, draft.scale.length));
    return;
  }
  if (!connect->is_bool()) connect->refuse("true, false, or a length");
  if (!connect->boolean()) return;
  if (draft.building.units.consistent) connect->refuse("a length, where the units are consistent ones");
  connect_parts(draft.building, usual_join_tolerance);
}

ModelRead read_document(const JsonDocument& document) {
  using namespace formats;
  const JsonValue root = document.root();
  if (!root.is_object()) root.refuse("an object");
  root.only({"topple",   "title",    "units",        "gravity",  "materials", "sections",
             "joints",   "nodes",    "members",      "panels",   "supports",  "diaphragms",
             "masses",   "loads",    "combinations", "building", "buildings", "joint_changes",
             "analyses", "frame3dd", "meshes",       "connect",  "cuts"});
  const JsonValue version = root.require("topple");
  if (!version.is_number() || version.number() != 1) version.refuse("1, the version of the format");
  ModelDraft draft;
  draft.building.file = document.name();
  if (const auto title = root.find("title")) draft.building.title = title->text();
  read_units(root, draft);
  read_materials(root, draft);
  read_sections(root, draft);
  read_joint_types(root, draft);
  read_case_names(root, draft);
  generate_buildings(root, draft);
  read_nodes(root, draft);
  read_members(root, draft);
  read_panels(root, draft);
  if (draft.building.members.empty() && draft.building.panels.empty())
    root.fail("the model has no member and no panel; accepted: at least one");
  draft.finish_joints();
  read_joint_changes(root, draft);
  read_supports(root, draft);
  read_diaphragms(root, draft);
  read_masses(root, draft);
  read_loads(root, draft);
  read_combinations(root, draft);
  read_analyses(root, draft);
  read_frame3dd_remarks(root, draft);
  read_connect(root, draft);
  if (const auto cuts = root.find("cuts")) (void)section_cuts(*cuts, draft.building);  // analyses read them again
  set_usual_meshes(draft.building);
  const std::vector<MeshEntry> meshes = read_meshes(root);  // what they draw is read when somebody draws or weighs it
  return {std::move(draft.building),
          std::any_of(meshes.begin(), meshes.end(), [](const MeshEntry& mesh) { return mesh.density > 0; })};
}

}  // namespace

Building formats::read_model_document(const JsonDocument& document, const std::filesystem::path& file,
                                      Purpose purpose) {
  ModelRead read = read_document(document);
  refuse_unbuilt(read.building, purpose);
  if (read.drawn_weight && purpose != Purpose::inspect) add_drawn_weight(read.building, file);
  return std::move(read.building);
}

Building parse_model(std::string_view text, const std::string& name, Purpose purpose) {
  Building building = read_document(JsonDocument::from_text(text, name)).building;
  refuse_unbuilt(building, purpose);
  return building;
}

Building parse_tables(const std::vector<std::pair<std::string, std::string>>& tables, const std::string& folder,
                      Purpose purpose) {
  ModelOfTables model = model_of_tables(tables, folder);
  Building building = read_document(JsonDocument::from_text(model.json, folder, {}, std::move(model.places))).building;
  refuse_unbuilt(building, purpose);
  return building;
}

Building read_model(const std::filesystem::path& file, Purpose purpose) {
  using namespace formats;
  const std::string ending = ending_of(file);
  ModelRead read;
  Building& building = read.building;
  if (ending == ".json")
    read = read_document(JsonDocument::from_file(file));
  else if (ending == ".3dd")
    building = parse_frame3dd(whole_text(file), file.filename().string());
  else if (std::error_code ignored; std::filesystem::is_directory(file, ignored))
    building = parse_tables(read_tables(file), file.string(), Purpose::inspect);
  else
    throw InputError(file.string() +
                     ": a model of unknown format; accepted: a file that ends in .json or .3dd, or a folder of tables");
  refuse_unbuilt(building, purpose);
  if (read.drawn_weight && purpose != Purpose::inspect) add_drawn_weight(building, file);
  return std::move(building);
}

}  // namespace topple::structure
