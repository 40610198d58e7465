// Nodes, members and panels that the file lists one by one.
#include <cmath>

#include "formats/model_reader.h"
#include "formats/read_fracture.h"
#include "mesh/usual_mesh.h"

namespace topple::structure::formats {

Vec3 read_point(const JsonValue& value, double factor) {
  value.expect_array(3, 3);
  Vec3 point;
  int i = 0;
  for (const JsonValue number : value) point[i++] = scaled(number, factor);
  return point;
}

std::vector<std::string> read_names(const JsonValue& list) {
  list.expect_array(0, ~std::size_t{0});
  std::vector<std::string> names;
  for (const JsonValue name : list) names.emplace_back(name.text("a name"));
  return names;
}

namespace {

PanelModel read_panel_model(const JsonValue& value) {
  const std::string_view model = value.text("\"membrane\", \"cladding\" or \"shell\"");
  if (model == "membrane") return PanelModel::membrane;
  if (model == "cladding") return PanelModel::cladding;
  if (model == "shell") return PanelModel::shell;
  value.refuse("\"membrane\", \"cladding\" or \"shell\"");
}

Span read_span(const JsonValue& value) {
  const std::string_view span = value.text("\"two-way\", \"x\" or \"y\"");
  if (span == "two-way") return Span::two_way;
  if (span == "x") return Span::x;
  if (span == "y") return Span::y;
  value.refuse("\"two-way\", \"x\" or \"y\"");
}

std::array<int, 2> read_mesh(const JsonValue& value) {
  constexpr int finest = 1000;
  if (value.is_number()) {
    const int n = static_cast<int>(value.whole(1, finest));
    return {n, n};
  }
  if (!value.is_array()) value.refuse("a whole number, or an array of two");
  value.expect_array(2, 2);
  std::array<int, 2> mesh{};
  std::size_t i = 0;
  for (const JsonValue n : value) mesh[i++] = static_cast<int>(n.whole(1, finest));
  return mesh;
}

std::vector<std::vector<Vec2>> read_openings(const JsonValue& value, const Scale& scale) {
  value.expect_array(0, ~std::size_t{0});
  std::vector<std::vector<Vec2>> openings;
  for (const JsonValue polygon : value) {
    polygon.expect_array(3, ~std::size_t{0});
    auto& points = openings.emplace_back();
    for (const JsonValue point : polygon) {
      point.expect_array(2, 2);
      auto number = point.begin();
      const double x = scaled(*number, scale.length);
      ++number;
      points.emplace_back(x, scaled(*number, scale.length));
    }
  }
  return openings;
}

}  // namespace

void read_panel_keys(const JsonValue& value, const Scale& scale, Panel& panel) {
  if (const auto model = value.find("model")) panel.model = read_panel_model(*model);
  if (const auto span = value.find("span")) panel.span = read_span(*span);
  if (const auto mesh = value.find("mesh"))
    panel.mesh = read_mesh(*mesh);
  else if (panel.model == PanelModel::shell)
    panel.mesh = mesh_not_given;  // by its span, when the whole model is read
  if (const auto fracture = value.find("fracture")) panel.fracture = read_fracture(*fracture, scale.length);
  if (const auto openings = value.find("openings")) panel.openings = read_openings(*openings, scale);
}

namespace {

MemberKind read_member_kind(const JsonValue& value) {
  const std::string_view kind = value.text("\"post\", \"beam\" or \"brace\"");
  if (kind == "post") return MemberKind::post;
  if (kind == "beam") return MemberKind::beam;
  if (kind == "brace") return MemberKind::brace;
  value.refuse("\"post\", \"beam\" or \"brace\"");
}

AxialAction read_axial(const JsonValue& value) {
  const std::string_view axial = value.text("\"both\", \"tension\" or \"compression\"");
  if (axial == "both") return AxialAction::both;
  if (axial == "tension") return AxialAction::tension;
  if (axial == "compression") return AxialAction::compression;
  value.refuse("\"both\", \"tension\" or \"compression\"");
}

template <std::size_t N>
std::array<NodeId, N> read_node_names(const JsonValue& value, const ModelDraft& draft) {
  value.expect_array(N, N);
  std::array<NodeId, N> nodes;
  std::size_t i = 0;
  for (const JsonValue name : value) {
    const NodeId node = draft.node(name);
    for (std::size_t j = 0; j < i; ++j)
      if (nodes[j] == node)
        name.fail("the node " + in_quotes(name.text()) + " stands twice; accepted: different nodes");
    nodes[i++] = node;
  }
  return nodes;
}

void read_member(const JsonValue& value, ModelDraft& draft) {
  value.only({"kind", "nodes", "section", "material", "up", "roll", "joints", "offsets", "axial", "groups", "design"});
  MemberDraft member;
  member.name = value.key();
  member.nodes = read_node_names<2>(value.require("nodes"), draft);
  member.section = draft.section(value.require("section"));
  member.material = draft.material(value.require("material"));
  for (const JsonValue entry : value) {
    const std::string_view key = entry.key();
    if (key == "kind") {
      member.kind = read_member_kind(entry);
    } else if (key == "up") {
      member.up = read_point(entry, 1);
      if (member.up->isZero(0)) entry.refuse("a direction");
    } else if (key == "roll") {
      member.roll = entry.number();
      constexpr double turn = 2 * 3.14159265358979323846;
      if (std::abs(member.roll) > turn)
        draft.building.warnings.push_back("member " + member.name +
                                          ": its roll is more than a turn; angles are in radians");
    } else if (key == "joints") {
      if (entry.is_null()) continue;
      if (!entry.is_array()) entry.refuse("an array of two joints, or null");
      entry.expect_array(2, 2);
      std::size_t end = 0;
      for (const JsonValue joint : entry) member.joints[end++] = draft.joint_type(joint);
    } else if (key == "offsets") {
      entry.expect_array(2, 2);
      std::size_t end = 0;
      for (const JsonValue arm : entry) member.offsets[end++] = read_point(arm, draft.scale.length);
    } else if (key == "axial") {
      member.axial = read_axial(entry);
    } else if (key == "groups") {
      member.groups = read_names(entry);
    } else if (key == "design") {
      member.design = read_member_design(entry, draft.scale);
    }
  }
  draft.add_member(member, value);
}

void read_panel(const JsonValue& value, ModelDraft& draft) {
  value.only(
      {"kind", "nodes", "thickness", "material", "model", "span", "mesh", "openings", "joint", "groups", "fracture"});
  PanelDraft draft_panel;
  Panel& panel = draft_panel.panel;
  panel.name = value.key();
  if (const auto kind = value.find("kind")) {
    const std::string_view name = kind->text("\"slab\" or \"wall\"");
    if (name != "slab" && name != "wall") kind->refuse("\"slab\" or \"wall\"");
    panel.kind = name == "wall" ? PanelKind::wall : PanelKind::slab;
  }
  panel.model = panel.kind == PanelKind::slab ? PanelModel::membrane : PanelModel::cladding;
  panel.nodes = read_node_names<4>(value.require("nodes"), draft);
  const JsonValue thickness = value.require("thickness");
  (void)thickness.positive();
  panel.thickness = scaled(thickness, draft.scale.length);
  panel.material = draft.material(value.require("material"));
  read_panel_keys(value, draft.scale, panel);
  if (const auto joint = value.find("joint")) draft_panel.joint = draft.joint_type(*joint);
  if (const auto groups = value.find("groups")) panel.groups = read_names(*groups);
  draft.add_panel(std::move(draft_panel), value);
}

}  // namespace

void read_nodes(const JsonValue& root, ModelDraft& draft) {
  const auto nodes = root.find("nodes");
  if (!nodes) return;
  nodes->expect_object();
  draft.reserve(nodes->size(), 0);
  for (const JsonValue value : *nodes)
    draft.add_node(std::string(value.key()), read_point(value, draft.scale.length), value);
}

void read_members(const JsonValue& root, ModelDraft& draft) {
  const auto members = root.find("members");
  if (!members) return;
  members->expect_object();
  draft.reserve(0, members->size());
  for (const JsonValue value : *members) read_member(value, draft);
}

void read_panels(const JsonValue& root, ModelDraft& draft) {
  const auto panels = root.find("panels");
  if (!panels) return;
  panels->expect_object();
  for (const JsonValue value : *panels) read_panel(value, draft);
}

}  // namespace topple::structure::formats
