// Tables to a JSON model, a line for each row, so that the reader of models says where in the tables something is
// wrong.
#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <unordered_map>

#include "formats/json/json_writer.h"
#include "formats/model_forms.h"
#include "formats/tables/csv_table.h"
#include "formats/tables/load_lines.h"
#include "formats/tables/model_tables.h"
#include "formats/tables/row_json.h"
#include "formats/tables/table_lists.h"
#include "topple/structure/error.h"

namespace topple::structure {

namespace {

using formats::in_quotes;
using formats::json_text;
using formats::needed;
using formats::quoted_list;

class ModelMaker {
 public:
  ModelMaker(const TextsByName& tables, const std::string& folder) : folder_(folder) {
    for (const auto& [file, text] : tables) {
      const auto known = std::find_if(model_tables::all.begin(), model_tables::all.end(),
                                      [&, name = std::string_view(file)](const auto& t) { return t.file == name; });
      if (known == model_tables::all.end()) {
        std::vector<std::string_view> accepted;
        for (const auto& table : model_tables::all) accepted.push_back(table.file);
        throw InputError(folder + ": there is no table " + in_quotes(file) + "; accepted: " + quoted_list(accepted));
      }
      tables_.try_emplace(std::string(known->file), text, folder + "/" + file, *known->columns);
    }
    if (!tables_.contains("nodes.csv"))
      throw InputError(folder +
                       ": the table \"nodes.csv\" is missing; accepted: a folder of tables, or a file of a "
                       "model (.json, .3dd)");
  }

  ModelOfTables make() {
    put("{\"topple\":1");
    model();
    each("materials.csv", ",\"materials\":{", [this](const CsvTable& t, std::size_t r) { plain_object(t, r, 1, {}); });
    each("sections.csv", ",\"sections\":{", [this](const CsvTable& t, std::size_t r) {
      plain_object(t, r, 1, {"shape", "catalogue"});
    });
    find_edge_joints();
    each("joints.csv", ",\"joints\":{", [this](const CsvTable& t, std::size_t r) { joint(t, r); });
    each("nodes.csv", ",\"nodes\":{", [this](const CsvTable& t, std::size_t r) { node(t, r); });
    if (const CsvTable* table = table_of("restraints.csv")) restraints_ = formats::ListsByPart::of_restraints(*table);
    each("members.csv", ",\"members\":{", [this](const CsvTable& t, std::size_t r) { member(t, r); });
    if (restraints_) restraints_->require_all_asked_for("member");
    if (const CsvTable* table = table_of("openings.csv")) openings_ = formats::ListsByPart::of_openings(*table);
    each("panels.csv", ",\"panels\":{", [this](const CsvTable& t, std::size_t r) { panel(t, r); });
    if (openings_) openings_->require_all_asked_for("panel");
    each("supports.csv", ",\"supports\":{", [this](const CsvTable& t, std::size_t r) { support(t, r); });
    lines("diaphragms.csv", ",\"diaphragms\":{", formats::diaphragm_lines);
    lines("masses.csv", ",\"masses\":{", formats::mass_lines);
    lines("loads.csv", ",\"loads\":{", formats::load_lines);
    lines("combinations.csv", ",\"combinations\":{", formats::combination_lines);
    lines("cuts.csv", ",\"cuts\":{", formats::cut_lines);
    put("}");
    return std::move(made_);
  }

 private:
  // Lines of the JSON text and where their rows stand.

  void put(const std::string& line, std::string place = {}) {
    made_.json += line;
    made_.json += '\n';
    made_.places.push_back(place.empty() ? folder_ : std::move(place));
  }
  [[nodiscard]] const CsvTable* table_of(const std::string& file) const {
    const auto found = tables_.find(file);
    return found == tables_.end() || found->second.rows() == 0 ? nullptr : &found->second;
  }

  /// An object whose lines are made elsewhere.
  template <class Make>
  void lines(const std::string& file, const char* opening, Make lines_of) {
    const CsvTable* table = table_of(file);
    if (table == nullptr) return;
    put(opening, table->name());
    for (formats::MadeLine& line : lines_of(*table)) put(line.json, std::move(line.place));
    put("}", table->name());
  }

  /// One line for each row of a table, as the values of one object with the row's first cell as key.
  template <class Write>
  void each(const std::string& file, const char* opening, Write write) {
    const auto found = tables_.find(file);
    if (found == tables_.end()) return;
    const CsvTable& table = found->second;
    put(opening, table.name());
    std::unordered_map<std::string_view, std::size_t> seen;  // looked up only
    seen.reserve(table.rows());
    for (std::size_t row = 0; row < table.rows(); ++row) {
      const std::string_view part = table.text(row, 0);
      if (const auto [first, is_new] = seen.try_emplace(part, row); !is_new)
        table.fail(
            row, 0,
            in_quotes(part) + " stands twice, first in " + table.location(first->second) + "; accepted: each once");
      line_ = row == 0 ? "" : ",";
      line_ += json_text(part) + ":";
      write(table, row);
      put(line_, table.location(row));
    }
    put("}", table.name());
  }

  void add(bool& first, std::string_view key, const std::string& text) {
    if (!first) line_ += ',';
    first = false;
    line_ += json_text(key) + ":" + text;
  }

  // Tables of parts.

  void model() {
    const auto found = tables_.find("model.csv");
    if (found == tables_.end()) return;
    const CsvTable& table = found->second;
    std::vector<std::pair<std::string, std::size_t>> units;
    std::set<std::string, std::less<>> seen;
    for (std::size_t row = 0; row < table.rows(); ++row) {
      const std::string key(table.text(row, 0));
      if (!seen.insert(key).second) table.fail(row, 0, in_quotes(key) + " stands twice; accepted: each once");
      if (key == "title") {
        put(",\"title\":" + json_text(table.cell(row, 1)), table.location(row));
      } else if (key == "gravity") {
        (void)table.text(row, 1);
        put(",\"gravity\":" + json_number(*table.number(row, 1)), table.location(row));
      } else if (key == "length" || key == "force" || key == "mass") {
        units.emplace_back(key, row);
      } else if (key == "units") {
        if (table.cell(row, 1) != "consistent")
          table.fail(row, 1, "found " + in_quotes(table.cell(row, 1)) + "; accepted: \"consistent\"");
        put(",\"units\":\"consistent\"", table.location(row));
      } else {
        table.fail(row, 0,
                   "found " + in_quotes(key) +
                       "; accepted: \"title\", \"gravity\", \"length\", \"force\", \"mass\", "
                       "\"units\"");
      }
    }
    if (units.empty()) return;
    if (seen.contains("units"))
      table.fail(units.front().second, 0, "a unit beside \"units\"; accepted: one or the other");
    put(",\"units\":{", table.name());
    bool first = true;
    for (const auto& [key, row] : units) {
      line_.clear();
      if (!first) line_ = ",";
      first = false;
      put(line_ + json_text(key) + ":" + json_text(table.text(row, 1)), table.location(row));
    }
    put("}", table.name());
  }

  /// Cells from `begin` on as the keys of their columns: numbers, texts, true and false.
  void plain_object(const CsvTable& table, std::size_t row, std::size_t begin,
                    const std::vector<std::string_view>& texts) {
    const auto& columns = columns_of(table);
    line_ += '{';
    bool first = true;
    for (std::size_t c = begin; c < columns.size(); ++c) {
      const std::string_view cell = table.cell(row, c);
      if (cell.empty()) continue;
      if (std::find(texts.begin(), texts.end(), columns[c]) != texts.end())
        add(first, columns[c], json_text(cell));
      else if (cell == "true" || cell == "false")
        add(first, columns[c], std::string(cell));
      else
        add(first, columns[c], json_number(*table.number(row, c)));
    }
    line_ += '}';
  }
  [[nodiscard]] const model_tables::Columns& columns_of(const CsvTable& table) const {
    for (const auto& known : model_tables::all)
      if (table.name() == folder_ + "/" + std::string(known.file)) return *known.columns;
    throw std::logic_error("a table that is none");
  }

  /// Capacities of joints that panels have are per length of edge.
  void find_edge_joints() {
    const auto found = tables_.find("panels.csv");
    if (found == tables_.end()) return;
    constexpr std::size_t joint_column = 10;
    for (std::size_t row = 0; row < found->second.rows(); ++row)
      edge_joints_.insert(found->second.cell(row, joint_column));
  }

  void joint(const CsvTable& table, std::size_t row) {
    constexpr std::size_t first_capacity = 2, first_stiffness = 9, from_column = 15, interaction = 17, end = 21;
    line_ += '{';
    bool first = true;
    if (const auto strength = table.number(row, 1)) add(first, "strength", json_number(*strength));
    const auto numbers = [&](std::size_t begin, std::size_t stop, std::size_t prefix = 0) {
      std::string inside;
      for (std::size_t c = begin; c < stop; ++c)
        if (const auto number = table.number(row, c))
          inside += (inside.empty() ? "" : ",") + json_text(model_tables::joints[c].substr(prefix)) + ":" +
                    json_number(*number);
      return inside;
    };
    std::string capacity = numbers(first_capacity, first_stiffness);
    if (const std::string_view source = table.cell(row, from_column); !source.empty())
      capacity += (capacity.empty() ? "" : ",") + std::string("\"from\":") + json_text(source);
    if (const std::string ratio = numbers(from_column + 1, interaction); !ratio.empty())
      capacity += (capacity.empty() ? "" : ",") + ratio;
    const auto object = [&](const char* key, const std::string& inside) {
      if (!inside.empty()) add(first, key, "{" + inside + "}");
    };
    object(edge_joints_.contains(table.cell(row, 0)) ? "capacity_per_length" : "capacity", capacity);
    object("stiffness", numbers(first_stiffness, from_column));
    if (const std::string_view cell = table.cell(row, interaction); !cell.empty())
      add(first, "interaction", json_text(cell));
    object("ductility", numbers(interaction + 1, end, std::string_view("ductility_").size()));
    line_ += '}';
  }

  void node(const CsvTable& table, std::size_t row) {
    line_ += "[" + needed(table, row, 1) + "," + needed(table, row, 2) + "," + needed(table, row, 3) + "]";
  }

  void member(const CsvTable& table, std::size_t row) {
    line_ += '{';
    bool first = true;
    const auto text = [&](std::size_t column, const char* key) {
      if (!table.cell(row, column).empty()) add(first, key, json_text(table.cell(row, column)));
    };
    text(1, "kind");
    add(first, "nodes", "[" + json_text(table.text(row, 2)) + "," + json_text(table.text(row, 3)) + "]");
    text(4, "section");
    text(5, "material");
    if (!table.cell(row, 6).empty() || !table.cell(row, 7).empty() || !table.cell(row, 8).empty())
      add(first, "up", "[" + needed(table, row, 6) + "," + needed(table, row, 7) + "," + needed(table, row, 8) + "]");
    if (const auto roll = table.number(row, 9)) add(first, "roll", json_number(*roll));
    const auto joint = [&](std::size_t column) {
      return table.cell(row, column).empty() ? std::string("null") : json_text(table.cell(row, column));
    };
    if (!table.cell(row, 10).empty() || !table.cell(row, 11).empty())
      add(first, "joints", "[" + joint(10) + "," + joint(11) + "]");
    if (const std::string_view groups = table.cell(row, 12); !groups.empty()) add(first, "groups", group_list(groups));
    text(13, "axial");
    constexpr std::size_t first_offset = 14, end_of_offsets = 20;
    bool any_offset = false;
    for (std::size_t c = first_offset; c < end_of_offsets; ++c) any_offset = any_offset || !table.cell(row, c).empty();
    if (any_offset) {
      std::string arms;
      for (std::size_t c = first_offset; c < end_of_offsets; ++c)
        arms += (c == first_offset ? "[[" : c == first_offset + 3 ? "],[" : ",") + needed(table, row, c);
      add(first, "offsets", arms + "]]");
    }
    if (const std::string design = member_design(table, row); !design.empty()) add(first, "design", design);
    line_ += '}';
  }

  /// "none", or an object of the columns after it; distances of restraints from their own table.
  std::string member_design(const CsvTable& table, std::size_t row) {
    using model_tables::design_column, model_tables::restraints_column;
    std::string distances = restraints_ ? restraints_->of(table.cell(row, 0)) : std::string();
    std::string inside;
    for (std::size_t c = design_column + 1; c < model_tables::members.size(); ++c) {
      const std::string_view cell = table.cell(row, c);
      if (c == restraints_column && !distances.empty()) {
        if (!cell.empty())
          table.fail(row, c,
                     "found " + in_quotes(cell) + " beside distances in restraints.csv; accepted: one or the other");
      } else if (cell.empty()) {
        continue;
      }
      const std::string entry = c != restraints_column ? json_number(*table.number(row, c))
                                : distances.empty()    ? json_text(cell)
                                                       : std::move(distances);
      inside += (inside.empty() ? "" : ",") + json_text(model_tables::members[c]) + ":" + entry;
    }
    const std::string_view word = table.cell(row, design_column);
    if (word.empty()) return inside.empty() ? "" : "{" + inside + "}";
    if (word != "none")
      table.fail(row, design_column, "found " + in_quotes(word) + "; accepted: \"none\", or an empty cell");
    if (!inside.empty())
      table.fail(row, design_column,
                 "found \"none\" beside lengths, factors or restraints; accepted: one or the other");
    return json_text(word);
  }

  static std::string group_list(std::string_view cell) {
    std::string list = "[";
    while (true) {
      const std::size_t end = cell.find(model_tables::group_separator);
      list += json_text(cell.substr(0, end));
      if (end == std::string_view::npos) return list + "]";
      list += ',';
      cell.remove_prefix(end + 1);
    }
  }

  void panel(const CsvTable& table, std::size_t row) {
    line_ += '{';
    bool first = true;
    const auto text = [&](std::size_t column, const char* key) {
      if (!table.cell(row, column).empty()) add(first, key, json_text(table.cell(row, column)));
    };
    text(1, "kind");
    std::string nodes;
    for (std::size_t c = 2; c < 6; ++c) nodes += (c == 2 ? "[" : ",") + json_text(table.text(row, c));
    add(first, "nodes", nodes + "]");
    if (const auto thickness = table.number(row, 6)) add(first, "thickness", json_number(*thickness));
    text(7, "material");
    text(8, "model");
    if (const std::string_view mesh = table.cell(row, 9); !mesh.empty())
      add(first, "mesh", mesh_value(table, row, mesh));
    text(10, "joint");
    text(11, "span");
    if (const std::string_view groups = table.cell(row, 12); !groups.empty()) add(first, "groups", group_list(groups));
    if (openings_)
      if (const std::string list = openings_->of(table.cell(row, 0)); !list.empty()) add(first, "openings", list);
    line_ += '}';
  }

  /// "4" or "4x3".
  static std::string mesh_value(const CsvTable& table, std::size_t row, std::string_view mesh) {
    const std::size_t by = mesh.find('x');
    const auto is_whole = [](std::string_view part) {
      return !part.empty() && part.size() < 10 && part.front() != '0' &&
             part.find_first_not_of("0123456789") == std::string_view::npos;
    };
    if (by == std::string_view::npos && is_whole(mesh)) return std::string(mesh);
    if (by != std::string_view::npos && is_whole(mesh.substr(0, by)) && is_whole(mesh.substr(by + 1)))
      return "[" + std::string(mesh.substr(0, by)) + "," + std::string(mesh.substr(by + 1)) + "]";
    table.fail(row, 9, "found " + in_quotes(mesh) + "; accepted: a whole number, or two as \"4x3\"");
  }

  void support(const CsvTable& table, std::size_t row) {
    line_ += '{';
    bool first = true;
    for (std::size_t c = 1; c < 7; ++c) {
      const std::string_view cell = table.cell(row, c);
      if (cell.empty() || cell == "free") continue;
      if (cell == "fixed") {
        add(first, model_tables::supports[c], "true");
        continue;
      }
      const char start = cell.front();
      if (start != '+' && start != '-' && start != '.' && start != ',' && (start < '0' || start > '9'))
        table.fail(row, c, "found " + in_quotes(cell) + "; accepted: \"free\", \"fixed\", or a spring stiffness");
      add(first, model_tables::supports[c], json_number(*table.number(row, c)));
    }
    line_ += '}';
  }

  std::string folder_, line_;
  std::map<std::string, CsvTable> tables_;
  std::set<std::string_view, std::less<>> edge_joints_;
  std::optional<formats::ListsByPart> restraints_, openings_;
  ModelOfTables made_;
};

}  // namespace

ModelOfTables model_of_tables(const TextsByName& tables, const std::string& folder) {
  return ModelMaker(tables, folder).make();
}

}  // namespace topple::structure
