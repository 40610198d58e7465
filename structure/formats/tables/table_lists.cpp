#include "formats/tables/table_lists.h"

#include <algorithm>
#include <array>
#include <set>

#include "formats/json/json_document.h"
#include "formats/tables/model_tables.h"
#include "formats/tables/row_json.h"

namespace topple::structure::formats {

namespace {

/// Rows by a name, in the order in which the names first stand.
using Groups = std::vector<std::pair<std::string, std::vector<std::size_t>>>;

Groups groups_of(const CsvTable& table, std::size_t column, const std::vector<std::size_t>& rows) {
  Groups groups;
  std::map<std::string, std::size_t, std::less<>> known;
  for (const std::size_t row : rows) {
    const std::string name(table.text(row, column));
    const auto [at, is_new] = known.try_emplace(name, groups.size());
    if (is_new) groups.push_back({name, {}});
    groups[at->second].second.push_back(row);
  }
  return groups;
}

std::vector<std::size_t> all_rows(const CsvTable& table) {
  std::vector<std::size_t> rows(table.rows());
  for (std::size_t row = 0; row < rows.size(); ++row) rows[row] = row;
  return rows;
}

}  // namespace

ListsByPart ListsByPart::of_openings(const CsvTable& table) {
  enum Column : std::size_t { panel, opening, x, y };
  ListsByPart result(table);
  for (const auto& [name, rows] : groups_of(table, panel, all_rows(table))) {
    std::string list;
    for (const auto& [number, corners] : groups_of(table, opening, rows)) {
      std::string polygon;
      for (const std::size_t row : corners)
        polygon += (polygon.empty() ? "[" : ",[") + needed(table, row, x) + "," + needed(table, row, y) + "]";
      list += (list.empty() ? "[" : ",[") + polygon + "]";
    }
    result.lists_[name] = {"[" + list + "]", rows.front(), false};
  }
  return result;
}

ListsByPart ListsByPart::of_restraints(const CsvTable& table) {
  enum Column : std::size_t { member, at };
  ListsByPart result(table);
  for (const auto& [name, rows] : groups_of(table, member, all_rows(table))) {
    std::string list;
    for (const std::size_t row : rows) list += (list.empty() ? "" : ",") + needed(table, row, at);
    result.lists_[name] = {"[" + list + "]", rows.front(), false};
  }
  return result;
}

std::string ListsByPart::of(std::string_view part) {
  const auto found = lists_.find(part);
  if (found == lists_.end()) return {};
  found->second.asked_for = true;
  return found->second.json;
}

void ListsByPart::require_all_asked_for(std::string_view kind) const {
  std::size_t first = table_->rows();
  for (const auto& [name, list] : lists_)
    if (!list.asked_for) first = std::min(first, list.first_row);
  if (first < table_->rows())
    table_->fail(first, 0,
                 "there is no " + std::string(kind) + " " + in_quotes(table_->cell(first, 0)) +
                     "; accepted: the name of a " + std::string(kind));
}

std::vector<MadeLine> diaphragm_lines(const CsvTable& table) {
  enum Column : std::size_t { name, node };
  std::vector<MadeLine> lines;
  for (const auto& [diaphragm, rows] : groups_of(table, name, all_rows(table))) {
    lines.push_back({(lines.empty() ? "" : ",") + json_text(diaphragm) + ":[", table.location(rows.front())});
    for (const std::size_t row : rows)
      lines.push_back({(row == rows.front() ? "" : ",") + json_text(table.text(row, node)), table.location(row)});
    lines.push_back({"]", table.location(rows.back())});
  }
  return lines;
}

std::vector<MadeLine> mass_lines(const CsvTable& table) {
  enum Column : std::size_t { on, name, value, first_inertia, end = first_inertia + 3 };
  std::vector<MadeLine> lines;
  const std::array<std::string_view, 3> kinds{model_tables::on_node, model_tables::on_member, model_tables::on_load};
  for (std::size_t row = 0; row < table.rows(); ++row)
    if (const std::string_view kind = table.text(row, on); std::find(kinds.begin(), kinds.end(), kind) == kinds.end())
      table.fail(row, on, "found " + in_quotes(kind) + "; accepted: " + quoted_list({kinds.begin(), kinds.end()}));
  for (const std::string_view kind : kinds) {
    std::set<std::string, std::less<>> seen;
    for (std::size_t row = 0; row < table.rows(); ++row) {
      if (table.cell(row, on) != kind) continue;
      const std::string part(table.text(row, name));
      if (seen.empty())
        lines.push_back({(lines.empty() ? "" : ",") + json_text(std::string(kind) + "s") + ":{", table.location(row)});
      if (!seen.insert(part).second) table.fail(row, name, in_quotes(part) + " stands twice; accepted: each once");
      std::string mass = needed(table, row, value);
      bool inertia = false;
      for (std::size_t c = first_inertia; c < end; ++c) inertia = inertia || !table.cell(row, c).empty();
      if (inertia && kind != model_tables::on_node)
        table.fail(row, first_inertia, "the inertia of a " + std::string(kind) + "; accepted: of nodes");
      if (inertia) {
        mass = "[" + mass;
        for (std::size_t c = first_inertia; c < end; ++c) mass += "," + needed(table, row, c);
        mass += "]";
      }
      lines.push_back({(seen.size() == 1 ? "" : ",") + json_text(part) + ":" + mass, table.location(row)});
    }
    if (!seen.empty()) lines.push_back({"}", table.name()});
  }
  return lines;
}

std::vector<MadeLine> cut_lines(const CsvTable& table) {
  enum Column : std::size_t { name, at, normal = at + 3, along = normal + 3, parts = along + 3 };
  const auto vector = [&](std::size_t row, std::size_t first) {
    return "[" + needed(table, row, first) + "," + needed(table, row, first + 1) + "," + needed(table, row, first + 2) +
           "]";
  };
  std::vector<MadeLine> lines;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    std::string line = (lines.empty() ? "" : ",") + json_text(table.text(row, name)) + ":{\"at\":" + vector(row, at) +
                       ",\"normal\":" + vector(row, normal);
    bool directed = false;
    for (std::size_t c = along; c < parts; ++c) directed = directed || !table.cell(row, c).empty();
    if (directed) line += ",\"along\":" + vector(row, along);
    std::string list;
    for (std::string_view left = table.cell(row, parts); !left.empty();) {
      const std::size_t end = std::min(left.find(model_tables::group_separator), left.size());
      list += (list.empty() ? "" : ",") + json_text(left.substr(0, end));
      left.remove_prefix(std::min(end + 1, left.size()));
    }
    if (!list.empty()) line += ",\"parts\":[" + list + "]";
    lines.push_back({line + "}", table.location(row)});
  }
  return lines;
}

}  // namespace topple::structure::formats
