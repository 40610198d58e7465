#pragma once
// The stages of reading a model, in the order in which read_model.cpp calls them. Each takes the root object of the
// file.
#include "formats/model_draft.h"

namespace topple::structure::formats {

void read_units(const JsonValue& root, ModelDraft& draft);
void read_materials(const JsonValue& root, ModelDraft& draft);
void read_sections(const JsonValue& root, ModelDraft& draft);
void read_joint_types(const JsonValue& root, ModelDraft& draft);
/// Names only: the building generator refers to them before their contents can be read.
void read_case_names(const JsonValue& root, ModelDraft& draft);
/// `building` and `buildings`.
void generate_buildings(const JsonValue& root, ModelDraft& draft);
void read_nodes(const JsonValue& root, ModelDraft& draft);
void read_members(const JsonValue& root, ModelDraft& draft);
void read_panels(const JsonValue& root, ModelDraft& draft);
void read_supports(const JsonValue& root, ModelDraft& draft);
void read_diaphragms(const JsonValue& root, ModelDraft& draft);
void read_masses(const JsonValue& root, ModelDraft& draft);
void read_loads(const JsonValue& root, ModelDraft& draft);
void read_combinations(const JsonValue& root, ModelDraft& draft);
void read_joint_changes(const JsonValue& root, ModelDraft& draft);
void read_analyses(const JsonValue& root, ModelDraft& draft);
void read_frame3dd_remarks(const JsonValue& root, ModelDraft& draft);

// Pieces that several stages share.

/// Index of a component's name, or -1.
[[nodiscard]] int component_of(std::string_view name);
/// {"x": ..., "rz": ...} as six numbers, `factor(component)` applied; absent ones stay 0.
template <class Factor>
[[nodiscard]] Vec6 read_components(const JsonValue& object, Factor factor);
/// `fixed`, `pinned`, `roller`, or an object by component: per component 0 free, unlimited held, else a spring (SI).
[[nodiscard]] Vec6 read_support(const JsonValue& value, const Scale& scale);
[[nodiscard]] Vec3 read_point(const JsonValue& value, double factor);
[[nodiscard]] std::vector<std::string> read_names(const JsonValue& list);
[[nodiscard]] MemberDesign read_member_design(const JsonValue& value, const Scale& scale);
/// The keys that a panel of a model and one of a generator share: model, span, mesh, fracture, openings.
void read_panel_keys(const JsonValue& value, const Scale& scale, Panel& panel);

template <class Factor>
Vec6 read_components(const JsonValue& object, Factor factor) {
  object.only({"x", "y", "z", "rx", "ry", "rz"});
  Vec6 result = Vec6::Zero();
  for (const JsonValue value : object) {
    const int component = component_of(value.key());
    result[component] = scaled(value, factor(component));
  }
  return result;
}

}  // namespace topple::structure::formats
