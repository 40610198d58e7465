#include "formats/tables/load_lines.h"

#include <algorithm>
#include <array>
#include <initializer_list>
#include <set>
#include <unordered_map>

#include "formats/json/json_document.h"
#include "formats/tables/model_tables.h"
#include "formats/tables/row_json.h"

namespace topple::structure::formats {

namespace {

class LoadLines {
 public:
  std::vector<MadeLine> of(const CsvTable& table) {
    std::vector<Case> cases;
    std::unordered_map<std::string, std::size_t> case_of;  // looked up only
    for (std::size_t row = 0; row < table.rows(); ++row) {
      const std::string case_name(table.text(row, in_case));
      const auto [at, is_new] = case_of.try_emplace(case_name, cases.size());
      if (is_new) cases.push_back({case_name, row, {}, {}, {}});
      sort_row(table, row, cases[at->second]);
    }
    for (std::size_t k = 0; k < cases.size(); ++k) write_case(table, cases[k], k == 0);
    return std::move(lines_);
  }

 private:
  enum LoadColumn : std::size_t { in_case, on, name, type, component, value, value2, from, to, frame };
  struct Part {
    std::string on, name;
    std::vector<std::size_t> rows;
  };
  struct Case {
    std::string name;
    std::size_t first_row = 0;
    std::vector<Part> parts;
    std::vector<std::size_t> own_rows;  ///< self weight
    std::unordered_map<std::string, std::size_t> part_of;
  };

  void put(std::string json, std::string place) { lines_.push_back({std::move(json), std::move(place)}); }

  static void sort_row(const CsvTable& table, std::size_t row, Case& load_case) {
    const std::string_view acts_on = table.cell(row, on), kind = table.cell(row, type);
    if (acts_on == model_tables::on_model || (acts_on.empty() && kind == "self_weight")) {
      load_case.own_rows.push_back(row);
      return;
    }
    if (acts_on.empty()) {  // the case alone, which may hold nothing
      for (std::size_t c = name; c <= frame; ++c)
        if (!table.cell(row, c).empty()) table.fail(row, on, "the cell is empty; accepted: what the load is on");
      return;
    }
    for (std::string_view known :
         {model_tables::on_node, model_tables::on_member, model_tables::on_panel, model_tables::on_settlement}) {
      if (acts_on != known && acts_on != std::string(known) + "s") continue;
      if (known == model_tables::on_node && kind == "settlement") known = model_tables::on_settlement;
      const std::string part(table.text(row, name));
      const auto [at, is_new] = load_case.part_of.try_emplace(std::string(known) + "\n" + part, load_case.parts.size());
      if (is_new) load_case.parts.push_back({std::string(known), part, {}});
      load_case.parts[at->second].rows.push_back(row);
      return;
    }
    table.fail(row, on,
               "found " + in_quotes(acts_on) +
                   "; accepted: \"model\", \"node\", \"member\", \"panel\", \"settlement\", or nothing");
  }

  void write_case(const CsvTable& table, const Case& load_case, bool first) {
    put((first ? "" : ",") + json_text(load_case.name) + ":{", table.location(load_case.first_row));
    bool any = self_weight(table, load_case);
    const auto group = [&](std::string_view acts_on, const char* key, auto write) {
      bool opened = false;
      for (const Part& part : load_case.parts) {
        if (part.on != acts_on) continue;
        if (!opened) put((any ? "," : "") + json_text(key) + ":{", table.name());
        put((opened ? "," : "") + json_text(part.name) + ":", table.location(part.rows.front()));
        opened = any = true;
        write(part);
      }
      if (opened) put("}", table.name());
    };
    const auto by_component = [&](const Part& part) {
      component_object(table, part.rows, part.on == model_tables::on_node ? "force" : "settlement");
    };
    group(model_tables::on_panel, "panels", [&](const Part& part) { panel_loads(table, part.rows); });
    group(model_tables::on_node, "nodes", by_component);
    group(model_tables::on_member, "members", [&](const Part& part) { member_loads(table, part.rows); });
    group(model_tables::on_settlement, "settlements", by_component);
    put("}", table.name());
  }

  /// A multiple downwards (no component), or the components of a vector.
  bool self_weight(const CsvTable& table, const Case& load_case) {
    if (load_case.own_rows.empty()) return false;
    std::array<std::string, 3> vector{"0", "0", "0"};
    std::array<bool, 3> given{};
    for (const std::size_t row : load_case.own_rows) {
      only_cells(table, row, {on, type, component, value});
      if (table.cell(row, type) != "self_weight")
        table.fail(row, type, "found " + in_quotes(table.cell(row, type)) + "; accepted: \"self_weight\"");
      const std::string_view axis = table.cell(row, component);
      const std::string number = needed(table, row, value);
      if (axis.empty()) {
        if (load_case.own_rows.size() > 1)
          table.fail(row, component, "self weight stands twice in this case; accepted: once, or x, y and z");
        put("\"self_weight\":" + number, table.location(row));
        return true;
      }
      const std::size_t i = axis == "x" ? 0 : axis == "y" ? 1 : axis == "z" ? 2 : 3;
      if (i == 3)
        table.fail(row, component, "found " + in_quotes(axis) + "; accepted: \"x\", \"y\", \"z\", or nothing");
      if (given[i]) table.fail(row, component, in_quotes(axis) + " stands twice; accepted: each once");
      given[i] = true;
      vector[i] = number;
    }
    put("\"self_weight\":[" + vector[0] + "," + vector[1] + "," + vector[2] + "]",
        table.location(load_case.own_rows.front()));
    return true;
  }

  /// Refuses what stands in other cells than those (case and name may always be there).
  static void only_cells(const CsvTable& table, std::size_t row, std::initializer_list<std::size_t> columns) {
    for (std::size_t c = type; c <= frame; ++c)
      if (std::find(columns.begin(), columns.end(), c) == columns.end() && !table.cell(row, c).empty())
        table.fail(row, c, "found " + in_quotes(table.cell(row, c)) + "; accepted for this load: an empty cell");
  }

  void component_object(const CsvTable& table, const std::vector<std::size_t>& rows, std::string_view kind) {
    put("{", table.name());
    std::set<std::string, std::less<>> seen;
    for (const std::size_t row : rows) {
      only_cells(table, row, {type, component, value});
      if (table.cell(row, type) != kind && !table.cell(row, type).empty())
        table.fail(row, type, "found " + in_quotes(table.cell(row, type)) + "; accepted: " + in_quotes(kind));
      const std::string axis(table.text(row, component));
      if (!seen.insert(axis).second) table.fail(row, component, in_quotes(axis) + " stands twice; accepted: each once");
      put((seen.size() == 1 ? "" : ",") + json_text(axis) + ":" + needed(table, row, value), table.location(row));
    }
    put("}", table.name());
  }

  void panel_loads(const CsvTable& table, const std::vector<std::size_t>& rows) {
    put("{", table.name());
    std::set<std::string, std::less<>> seen;
    for (const std::size_t row : rows) {
      only_cells(table, row, {type, value});
      const std::string kind(table.text(row, type));
      if (!seen.insert(kind).second) table.fail(row, type, in_quotes(kind) + " stands twice; accepted: each once");
      put((seen.size() == 1 ? "" : ",") + json_text(kind) + ":" + needed(table, row, value), table.location(row));
    }
    put("}", table.name());
  }

  /// Components in rows that follow each other, alike but for the component, are one load.
  void member_loads(const CsvTable& table, const std::vector<std::size_t>& rows) {
    put("[", table.name());
    for (std::size_t k = 0; k < rows.size();) {
      const std::size_t row = rows[k];
      const std::string kind(table.text(row, type));
      check_member_load(table, row, kind);
      put((k == 0 ? "{" : ",{") + json_text(kind) + ":{", table.location(row));
      std::set<std::string, std::less<>> seen;
      for (; k < rows.size() && (seen.empty() || alike(table, row, rows[k])); ++k) {
        check_member_load(table, rows[k], kind);
        const std::string axis(table.text(rows[k], component));
        if (seen.contains(axis)) break;
        put((seen.empty() ? "" : ",") + json_text(axis) + ":" + member_value(table, rows[k], kind),
            table.location(rows[k]));
        seen.insert(axis);
      }
      std::string end = "}";
      if (kind == "point") {
        end += ",\"at\":" + needed(table, row, from);
      } else {
        if (const auto start = table.number(row, from)) end += ",\"from\":" + json_number(*start);
        if (const auto stop = table.number(row, to)) end += ",\"to\":" + json_number(*stop);
      }
      if (!table.cell(row, frame).empty()) end += ",\"frame\":" + json_text(table.cell(row, frame));
      put(end + "}", table.location(row));
    }
    put("]", table.name());
  }

  static bool alike(const CsvTable& table, std::size_t a, std::size_t b) {
    return std::all_of(std::begin(shared_cells), std::end(shared_cells),
                       [&](std::size_t c) { return table.cell(a, c) == table.cell(b, c); });
  }
  static constexpr std::array<std::size_t, 4> shared_cells{type, from, to, frame};

  static void check_member_load(const CsvTable& table, std::size_t row, const std::string& kind) {
    if (kind == "uniform")
      only_cells(table, row, {type, component, value, from, to, frame});
    else if (kind == "trapezoid")
      only_cells(table, row, {type, component, value, value2, from, to, frame});
    else if (kind == "point")
      only_cells(table, row, {type, component, value, from, frame});
    else if (kind == "temperature")
      only_cells(table, row, {type, component, value});
    else
      table.fail(row, type,
                 "found " + in_quotes(kind) + "; accepted: \"uniform\", \"trapezoid\", \"point\", \"temperature\"");
  }

  static std::string member_value(const CsvTable& table, std::size_t row, const std::string& kind) {
    if (kind != "trapezoid") return needed(table, row, value);
    return "[" + needed(table, row, value) + "," + needed(table, row, value2) + "]";
  }

  std::vector<MadeLine> lines_;
};

}  // namespace

std::vector<MadeLine> load_lines(const CsvTable& table) { return LoadLines().of(table); }

std::vector<MadeLine> combination_lines(const CsvTable& table) {
  std::vector<std::pair<std::string, std::vector<std::size_t>>> list;
  std::unordered_map<std::string, std::size_t> known;  // looked up only
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const std::string combination(table.text(row, 0));
    const auto [at, is_new] = known.try_emplace(combination, list.size());
    if (is_new) list.push_back({combination, {}});
    list[at->second].second.push_back(row);
  }
  std::vector<MadeLine> lines;
  for (std::size_t k = 0; k < list.size(); ++k) {
    lines.push_back({(k == 0 ? "" : ",") + json_text(list[k].first) + ":{", table.location(list[k].second.front())});
    std::set<std::string, std::less<>> seen;
    for (const std::size_t row : list[k].second) {
      const std::string load_case(table.text(row, 1));
      if (!seen.insert(load_case).second)
        table.fail(row, 1, in_quotes(load_case) + " stands twice in this combination; accepted: each once");
      lines.push_back(
          {(seen.size() == 1 ? "" : ",") + json_text(load_case) + ":" + needed(table, row, 2), table.location(row)});
    }
    lines.push_back({"}", table.name()});
  }
  return lines;
}

}  // namespace topple::structure::formats
