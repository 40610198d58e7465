// Supports, diaphragms, masses.
#include "formats/model_reader.h"
#include "model/index_of.h"

namespace topple::structure::formats {

int component_of(std::string_view name) {
  for (std::size_t c = 0; c < 6; ++c)
    if (name == component_names[c]) return static_cast<int>(c);
  return -1;
}

Vec6 read_support(const JsonValue& value, const Scale& scale) {
  constexpr const char* accepted =
      "\"fixed\", \"pinned\", \"roller\", or an object with true or a spring stiffness by component";
  Vec6 stiffness = Vec6::Zero();
  if (value.is_text()) {
    const std::string_view name = value.text();
    if (name == "fixed")
      stiffness.setConstant(unlimited);
    else if (name == "pinned")
      stiffness.head<3>().setConstant(unlimited);
    else if (name == "roller")
      stiffness[2] = unlimited;
    else
      value.refuse(accepted);
    return stiffness;
  }
  if (!value.is_object()) value.refuse(accepted);
  value.only({"x", "y", "z", "rx", "ry", "rz"});
  for (const JsonValue entry : value) {
    const int component = component_of(entry.key());
    if (entry.is_bool()) {
      if (!entry.boolean()) entry.refuse("true, or a spring stiffness above 0 (leave a free component out)");
      stiffness[component] = unlimited;
    } else {
      if (!entry.is_number() || !(entry.number() > 0)) entry.refuse("true, or a spring stiffness above 0");
      stiffness[component] = scaled(entry, scale.stiffness(component));
    }
  }
  return stiffness;
}

namespace {

/// "W1:3" as panel and edge, when there is such a shell.
std::optional<EdgeSupport> edge_of(const JsonValue& value, const ModelDraft& draft) {
  const std::string_view name = value.key();
  if (name.size() < 3 || name[name.size() - 2] != ':' || name.back() < '1' || name.back() > '4') return std::nullopt;
  const auto panel = draft.find_panel(name.substr(0, name.size() - 2));
  if (!panel) return std::nullopt;
  if (draft.building[*panel].model != PanelModel::shell)
    value.fail(
        "a support of the edge of a panel that is no shell; accepted: nodes, and edges of panels of model \"shell\"");
  return EdgeSupport{*panel, name.back() - '1', Vec6::Zero()};
}

void read_node_mass(const JsonValue& value, ModelDraft& draft) {
  NodeMass mass;
  mass.node = draft.node_of_key(value);
  const double inertia = draft.scale.mass * draft.scale.area();
  if (value.is_array()) {
    value.expect_array(4, 4);
    int i = 0;
    for (const JsonValue number : value) {
      (void)number.not_negative();
      const double scaled_number = scaled(number, i == 0 ? draft.scale.mass : inertia);
      (i == 0 ? mass.mass : mass.inertia[i - 1]) = scaled_number;
      ++i;
    }
  } else {
    if (!value.is_number() || !(value.number() >= 0)) value.refuse("a mass, or [mass, Ixx, Iyy, Izz]");
    mass.mass = scaled(value, draft.scale.mass);
  }
  draft.building.masses.nodes.push_back(mass);
}

}  // namespace

void read_supports(const JsonValue& root, ModelDraft& draft) {
  const auto supports = root.find("supports");
  if (!supports) return;
  supports->expect_object();
  for (const JsonValue value : *supports) {
    if (!draft.find_node(value.key()))
      if (auto edge = edge_of(value, draft)) {
        edge->stiffness = read_support(value, draft.scale);
        draft.building.edge_supports.push_back(*edge);
        continue;
      }
    draft.add_support({draft.node_of_key(value), read_support(value, draft.scale)}, value);
  }
}

void read_diaphragms(const JsonValue& root, ModelDraft& draft) {
  const auto diaphragms = root.find("diaphragms");
  if (!diaphragms) return;
  diaphragms->expect_object();
  std::vector<std::int32_t> diaphragm_of_node(draft.building.nodes.size(), -1);
  for (const JsonValue value : *diaphragms) {
    value.expect_array(1, ~std::size_t{0});
    Diaphragm diaphragm;
    diaphragm.name = value.key();
    const auto index = static_cast<std::int32_t>(draft.building.diaphragms.size());
    const auto bind = [&](NodeId node, const JsonValue& name) {
      std::int32_t& bound = diaphragm_of_node[index_of(node)];
      if (bound == index) return;
      if (bound >= 0)
        name.fail("the node " + in_quotes(draft.building[node].name) +
                  " is in another diaphragm; accepted: one for each node");
      bound = index;
      diaphragm.nodes.push_back(node);
    };
    for (const JsonValue name : value) {
      const std::string_view pattern = name.text("the name of a node, or a pattern with *");
      if (pattern.find('*') == std::string_view::npos) {
        bind(draft.node(name), name);
        continue;
      }
      const std::size_t before = diaphragm.nodes.size();
      for (std::size_t i = 0; i < draft.building.nodes.size(); ++i)
        if (matches_pattern(pattern, draft.building.nodes[i].name)) bind(NodeId(i), name);
      if (diaphragm.nodes.size() == before)
        name.fail("the pattern " + in_quotes(pattern) + " matches no further node; accepted: one that matches");
    }
    draft.building.diaphragms.push_back(std::move(diaphragm));
  }
}

void read_masses(const JsonValue& root, ModelDraft& draft) {
  const auto masses = root.find("masses");
  if (!masses) return;
  masses->only({"nodes", "members", "loads"});
  if (const auto nodes = masses->find("nodes")) {
    nodes->expect_object();
    for (const JsonValue value : *nodes) read_node_mass(value, draft);
  }
  if (const auto members = masses->find("members")) {
    members->expect_object();
    for (const JsonValue value : *members) {
      (void)value.not_negative();
      draft.building.masses.members.emplace_back(draft.member_of_key(value), scaled(value, draft.scale.mass));
    }
  }
  if (const auto loads = masses->find("loads")) {
    loads->expect_object();
    for (const JsonValue value : *loads)
      draft.building.masses.loads.emplace_back(draft.case_of_key(value), value.not_negative());
  }
}

}  // namespace topple::structure::formats
