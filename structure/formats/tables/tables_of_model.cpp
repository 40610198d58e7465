// A JSON model as tables. What they cannot hold is refused by its name; numbers go over as they stand.
#include <algorithm>
#include <set>

#include "formats/model_forms.h"
#include "formats/tables/model_tables.h"
#include "formats/tables/table_text.h"
#include "formats/tables/tables_of_lists.h"

namespace topple::structure {

namespace {

using formats::hold_only;
using formats::JsonDocument;
using formats::JsonValue;
using formats::refuse;
using formats::TableText;

class TableMaker {
 public:
  explicit TableMaker(const JsonDocument& model) : root_(model.root()) {}

  TextsByName make() {
    hold_only(
        root_,
        {"topple", "title", "units", "gravity", "materials", "sections", "joints", "nodes", "members", "panels",
         "supports", "diaphragms", "masses", "loads", "combinations", "cuts"},
        "materials, sections, joints, nodes, members, panels, supports, diaphragms, masses, loads, combinations, cuts");
    model();
    plain("materials.csv", "materials", model_tables::materials);
    plain("sections.csv", "sections", model_tables::sections);
    find_edge_joints();
    each("joints.csv", "joints", joint_columns(), [this](TableText& t, const JsonValue& v) { joint(t, v); });
    each("nodes.csv", "nodes", model_tables::nodes, [](TableText& t, const JsonValue& v) { node(t, v); });
    each("members.csv", "members", member_columns(), [](TableText& t, const JsonValue& v) { member(t, v); });
    inner("restraints.csv", "members", model_tables::restraints, formats::restraint_rows);
    each("panels.csv", "panels", used(model_tables::panels, "panels", {{"span", "span"}, {"groups", "groups"}}),
         [](TableText& t, const JsonValue& v) { panel(t, v); });
    inner("openings.csv", "panels", model_tables::openings, formats::opening_rows);
    each("supports.csv", "supports", model_tables::supports, [](TableText& t, const JsonValue& v) { support(t, v); });
    inner("diaphragms.csv", "diaphragms", model_tables::diaphragms, formats::diaphragm_rows);
    inner("masses.csv", "masses", model_tables::masses, formats::mass_rows);
    loads();
    combinations();
    each("cuts.csv", "cuts", model_tables::cuts, [](TableText& t, const JsonValue& v) { cut(t, v); });
    return std::move(files_);
  }

 private:
  void keep(std::string_view file, TableText& table) {
    if (table.rows() > 0 || file == "nodes.csv") files_.emplace_back(file, table.release());
  }

  /// Columns (by how their names begin) that are written only where some part has their key.
  using Optional = std::vector<std::pair<std::string_view, std::string_view>>;

  [[nodiscard]] model_tables::Columns used(model_tables::Columns columns, const char* parts, Optional keys) const {
    if (const auto object = root_.find(parts))
      for (const JsonValue part : *object)
        std::erase_if(keys, [&](const auto& key) { return part.find(key.first).has_value(); });
    for (const auto& [key, column] : keys)
      std::erase_if(columns, [&](std::string_view name) { return name.starts_with(column); });
    return columns;
  }

  /// A table with a row for each value of an object, whose key is the first cell.
  template <class Write>
  void each(std::string_view file, const char* key, const model_tables::Columns& columns, Write write) {
    TableText table(columns);
    if (const auto object = root_.find(key))
      for (const JsonValue value : *object) {
        check_name(value);
        table.set(columns.front(), value.key());
        write(table, value);
        table.end_row();
      }
    keep(file, table);
  }
  static void check_name(const JsonValue& value) {
    if (value.key().find('\0') != std::string_view::npos) refuse(value, "a name without a null character");
  }
  /// A table whose rows come from within the values of an object.
  template <class Write>
  void inner(std::string_view file, const char* key, const model_tables::Columns& columns, Write write) {
    TableText table(columns);
    if (const auto object = root_.find(key))
      for (const JsonValue value : *object) {
        check_name(value);
        write(table, value);
      }
    keep(file, table);
  }
  void plain(std::string_view file, const char* key, const model_tables::Columns& columns) {
    each(file, key, columns, [&](TableText& table, const JsonValue& value) {
      hold_only(value, {columns.begin() + 1, columns.end()}, "numbers and names");
      for (const JsonValue entry : value) table.set(entry.key(), entry);
    });
  }

  void model() {
    TableText table(model_tables::model);
    const auto row = [&](std::string_view key, const JsonValue& value) {
      table.set("key", key).set("value", value).end_row();
    };
    if (const auto title = root_.find("title")) row("title", *title);
    if (const auto gravity = root_.find("gravity")) row("gravity", *gravity);
    if (const auto units = root_.find("units")) {
      if (units->is_text())
        row("units", *units);
      else
        for (const JsonValue unit : *units) row(unit.key(), unit);
    }
    keep("model.csv", table);
  }

  // Joints. Whether a joint's capacities are those of a member's end or of an edge, per length, is told by who has it.

  void find_edge_joints() {
    if (const auto panels = root_.find("panels"))
      for (const JsonValue panel : *panels)
        if (const auto joint = panel.find("joint"); joint && !joint->is_null()) edge_joints_.emplace(joint->text());
    if (const auto members = root_.find("members"))
      for (const JsonValue member : *members)
        if (const auto joints = member.find("joints"); joints && joints->is_array())
          for (const JsonValue joint : *joints)
            if (!joint.is_null()) member_joints_.emplace(joint.text());
  }

  /// How capacities are derived and combined, and how far a joint turns: only where some joint says so.
  [[nodiscard]] model_tables::Columns joint_columns() const {
    model_tables::Columns columns =
        used(model_tables::joints, "joints", {{"interaction", "interaction"}, {"ductility", "ductility"}});
    if (const auto joints = root_.find("joints"))
      for (const JsonValue joint : *joints)
        if (const auto capacity = joint.find("capacity"); capacity && capacity->find("from")) return columns;
    std::erase_if(columns, [](std::string_view name) { return name == "from" || name == "ratio"; });
    return columns;
  }

  /// Of what a check needs to know only the columns that some member has.
  [[nodiscard]] model_tables::Columns member_columns() const {
    model_tables::Columns columns = used(model_tables::members, "members", {{"axial", "axial"}, {"offsets", "offset"}});
    std::set<std::string_view, std::less<>> keys;
    if (const auto members = root_.find("members"))
      for (const JsonValue member : *members)
        if (const auto design = member.find("design")) formats::design_columns(*design, keys);
    const auto& all = model_tables::members;
    for (std::size_t c = model_tables::design_column; c < all.size(); ++c)
      if (!keys.contains(all[c])) std::erase(columns, all[c]);
    return columns;
  }

  void joint(TableText& table, const JsonValue& value) const {
    hold_only(value, {"strength", "capacity", "capacity_per_length", "stiffness", "interaction", "ductility"},
              "strength, capacity, stiffness, interaction, ductility");
    if (const auto interaction = value.find("interaction")) table.set("interaction", *interaction);
    if (const auto ductility = value.find("ductility")) {
      if (ductility->size() == 0) refuse(*ductility, "at least one sense");
      for (const JsonValue number : *ductility) table.set("ductility_" + std::string(number.key()), number);
    }
    if (const auto strength = value.find("strength")) table.set("strength", *strength);
    const bool of_edges = edge_joints_.contains(value.key()), of_members = member_joints_.contains(value.key());
    if (const auto capacity = value.find("capacity")) {
      if (of_edges && !of_members) refuse(*capacity, "`capacity_per_length` of a joint that panels have");
      capacities(table, *capacity);
    }
    if (const auto capacity = value.find("capacity_per_length")) {
      if (!of_edges || of_members) refuse(*capacity, "joints that panels alone have");
      capacities(table, *capacity);
    }
    if (const auto stiffness = value.find("stiffness")) {
      if (stiffness->size() == 0) refuse(*stiffness, "at least one stiffness");
      for (const JsonValue number : *stiffness) table.set(number.key(), number);
    }
  }

  /// Seven numbers, or the original program's thresholds of forces and moments, which are seven numbers too.
  static void capacities(TableText& table, const JsonValue& capacity) {
    if (capacity.size() == 0) refuse(capacity, "at least one capacity");
    hold_only(capacity,
              {"tension", "compression", "shear_y", "shear_z", "torsion", "moment_y", "moment_z", "force", "moment",
               "from", "ratio"},
              "capacities as numbers");
    for (const JsonValue value : capacity)
      if (value.key() == "force") {
        auto number = value.begin();
        table.set("tension", *number).set("compression", *number);
        ++number;
        table.set("shear_y", *number);
        ++number;
        table.set("shear_z", *number);
      } else if (value.key() == "moment") {
        list(table, std::array<const char*, 3>{"torsion", "moment_y", "moment_z"}, value);
      }
    for (const JsonValue value : capacity)
      if (value.is_number() || value.key() == "from") table.set(value.key(), value);
  }

  template <std::size_t N>
  static void list(TableText& table, const std::array<const char*, N>& columns, const JsonValue& values) {
    std::size_t i = 0;
    for (const JsonValue value : values)
      if (i < N) table.set(columns[i++], value);
  }

  static void node(TableText& table, const JsonValue& value) {
    list(table, std::array<const char*, 3>{"x", "y", "z"}, value);
  }

  static void member(TableText& table, const JsonValue& value) {
    hold_only(value,
              {"kind", "nodes", "section", "material", "up", "roll", "joints", "groups", "axial", "offsets", "design"},
              "kind, nodes, section, material, up, roll, joints, groups, axial, offsets, design");
    list(table, std::array<const char*, 2>{"node1", "node2"}, value.require("nodes"));
    for (const char* key : {"kind", "section", "material", "roll", "axial"})
      if (const auto entry = value.find(key)) table.set(key, *entry);
    if (const auto up = value.find("up")) list(table, std::array<const char*, 3>{"upx", "upy", "upz"}, *up);
    if (const auto joints = value.find("joints"); joints && joints->is_array()) {
      const char* column = "joint1";
      for (const JsonValue joint : *joints) {
        if (!joint.is_null()) table.set(column, joint);
        column = "joint2";
      }
    }
    if (const auto offsets = value.find("offsets")) {
      std::array<const char*, 3> columns{"offset1x", "offset1y", "offset1z"};
      for (const JsonValue arm : *offsets) {
        list(table, columns, arm);
        columns = {"offset2x", "offset2y", "offset2z"};
      }
    }
    groups(table, value);
    if (const auto design = value.find("design")) formats::design_cells(table, *design);
  }

  static void groups(TableText& table, const JsonValue& value) {
    if (const auto groups = value.find("groups")) names(table, "groups", *groups, "names of groups without \";\"");
  }
  static void names(TableText& table, std::string_view column, const JsonValue& list, const char* accepted) {
    std::string cell;
    for (const JsonValue name : list) {
      if (name.text().empty() || name.text().find(model_tables::group_separator) != std::string_view::npos)
        refuse(name, accepted);
      cell += (cell.empty() ? "" : std::string(1, model_tables::group_separator)) + std::string(name.text());
    }
    if (!cell.empty()) table.set(column, cell);
  }

  static void cut(TableText& table, const JsonValue& value) {
    list(table, std::array<const char*, 3>{"x", "y", "z"}, value.require("at"));
    list(table, std::array<const char*, 3>{"normal_x", "normal_y", "normal_z"}, value.require("normal"));
    if (const auto along = value.find("along"))
      list(table, std::array<const char*, 3>{"along_x", "along_y", "along_z"}, *along);
    if (const auto parts = value.find("parts")) names(table, "parts", *parts, "names of parts without \";\"");
  }

  static void panel(TableText& table, const JsonValue& value) {
    hold_only(value, {"kind", "nodes", "thickness", "material", "model", "mesh", "joint", "span", "groups", "openings"},
              "kind, nodes, thickness, material, model, mesh, joint, span, groups, openings");
    list(table, std::array<const char*, 4>{"node1", "node2", "node3", "node4"}, value.require("nodes"));
    for (const char* key : {"kind", "thickness", "material", "model", "span"})
      if (const auto entry = value.find(key)) table.set(key, *entry);
    groups(table, value);
    if (const auto joint = value.find("joint"); joint && !joint->is_null()) table.set("joint", *joint);
    if (const auto mesh = value.find("mesh")) {
      std::string cell;
      if (mesh->is_number())
        cell = mesh->found();
      else
        for (const JsonValue number : *mesh) cell += (cell.empty() ? "" : "x") + number.found();
      table.set("mesh", cell);
    }
  }

  /// Of a node, or of a shell's edge by its joint's name.
  static void support(TableText& table, const JsonValue& value) {
    constexpr std::array<const char*, 6> components{"x", "y", "z", "rx", "ry", "rz"};
    if (value.is_text()) {
      const std::size_t held = value.text() == "fixed" ? 6 : value.text() == "pinned" ? 3 : 0;
      for (std::size_t i = 0; i < held; ++i) table.set(components[i], std::string_view("fixed"));
      if (value.text() == "roller") table.set("z", std::string_view("fixed"));
      return;
    }
    for (const JsonValue entry : value)
      if (entry.is_bool())
        table.set(entry.key(), std::string_view("fixed"));
      else
        table.set(entry.key(), entry);
  }
  // Loads.

  struct Row {
    std::string_view load_case, on, name, type;
  };
  static TableText& start(TableText& table, const Row& row) {
    table.set("case", row.load_case).set("on", row.on).set("name", row.name);
    return table.set("type", row.type);
  }

  void loads() {
    TableText table(model_tables::loads);
    if (const auto loads = root_.find("loads"))
      for (const JsonValue value : *loads) {
        const std::size_t before = table.rows();
        load_case(table, value);
        if (table.rows() == before) table.set("case", value.key()).end_row();
      }
    keep("loads.csv", table);
  }

  static void load_case(TableText& table, const JsonValue& value) {
    const std::string_view name = value.key();
    if (const auto weight = value.find("self_weight")) self_weight(table, name, *weight);
    if (const auto panels = value.find("panels"))
      for (const JsonValue panel : *panels) {
        if (panel.size() == 0) refuse(panel, "at least one load of a panel that is named");
        for (const JsonValue load : panel)
          start(table, {name, model_tables::on_panel, panel.key(), load.key()}).set("value", load).end_row();
      }
    components(table, value, "nodes", model_tables::on_node, "force");
    if (const auto members = value.find("members"))
      for (const JsonValue list : *members) {
        if (list.size() == 0) refuse(list, "at least one load of a member that is named");
        for (const JsonValue load : list) member_load(table, {name, model_tables::on_member, list.key(), {}}, load);
      }
    components(table, value, "settlements", model_tables::on_settlement, "settlement");
  }

  static void self_weight(TableText& table, std::string_view load_case, const JsonValue& weight) {
    const Row row{load_case, model_tables::on_model, {}, "self_weight"};
    if (!weight.is_array()) {
      start(table, row).set("value", weight).end_row();
      return;
    }
    constexpr std::array<std::string_view, 3> axes{"x", "y", "z"};
    std::size_t i = 0;
    for (const JsonValue number : weight) start(table, row).set("component", axes[i++]).set("value", number).end_row();
  }

  static void components(TableText& table, const JsonValue& load_case, const char* key, std::string_view on,
                         std::string_view type) {
    if (const auto nodes = load_case.find(key))
      for (const JsonValue node : *nodes) {
        if (node.size() == 0) refuse(node, "at least one component of a node that is named");
        for (const JsonValue number : node)
          start(table, {load_case.key(), on, node.key(), type})
              .set("component", number.key())
              .set("value", number)
              .end_row();
      }
  }

  static void member_load(TableText& table, Row row, const JsonValue& load) {
    const JsonValue first = *load.begin();
    JsonValue object = first;
    for (const char* type : {"uniform", "trapezoid", "point", "temperature"})
      if (const auto found = load.find(type)) {
        row.type = found->key();
        object = *found;
      }
    if (object.size() == 0) refuse(object, "at least one component");
    if (row.type == "temperature") hold_only(object, {"uniform", "gradient_y", "gradient_z"}, "uniform, gradients");
    for (const JsonValue value : object) {
      start(table, row).set("component", value.key());
      if (value.is_array())
        list(table, std::array<const char*, 2>{"value", "value2"}, value);
      else
        table.set("value", value);
      if (const auto at = load.find("at")) table.set("from", *at);
      for (const char* key : {"from", "to", "frame"})
        if (const auto entry = load.find(key)) table.set(key, *entry);
      table.end_row();
    }
  }

  void combinations() {
    TableText table(model_tables::combinations);
    if (const auto combinations = root_.find("combinations"))
      for (const JsonValue combination : *combinations)
        for (const JsonValue factor : combination)
          table.set("name", combination.key()).set("case", factor.key()).set("factor", factor).end_row();
    keep("combinations.csv", table);
  }

  JsonValue root_;
  TextsByName files_;
  std::set<std::string_view, std::less<>> edge_joints_, member_joints_;
};

}  // namespace

TextsByName tables_of_model(const JsonDocument& model) { return TableMaker(model).make(); }

}  // namespace topple::structure
