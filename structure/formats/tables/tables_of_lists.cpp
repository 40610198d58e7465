#include "formats/tables/tables_of_lists.h"

#include <array>
#include <optional>

namespace topple::structure::formats {

namespace {

/// Distances of restraints, where there are any: a word, or a list of none, is a cell of the member.
std::optional<JsonValue> distances(const JsonValue& design) {
  if (!design.is_object()) return std::nullopt;
  const auto restraints = design.find("restraints");
  return restraints && restraints->is_array() && restraints->size() > 0 ? restraints : std::nullopt;
}

}  // namespace

void restraint_rows(TableText& table, const JsonValue& member) {
  const auto design = member.find("design");
  if (!design) return;
  if (const auto list = distances(*design))
    for (const JsonValue at : *list) table.set("member", member.key()).set("at", at).end_row();
}

void opening_rows(TableText& table, const JsonValue& panel) {
  const auto openings = panel.find("openings");
  if (!openings) return;
  double number = 0;
  for (const JsonValue opening : *openings) {
    number += 1;
    for (const JsonValue corner : opening) {
      table.set("panel", panel.key()).set("opening", number);
      const char* column = "x";
      for (const JsonValue coordinate : corner) {
        table.set(column, coordinate);
        column = "y";
      }
      table.end_row();
    }
  }
}

void diaphragm_rows(TableText& table, const JsonValue& diaphragm) {
  for (const JsonValue node : diaphragm) table.set("name", diaphragm.key()).set("node", node).end_row();
}

void mass_rows(TableText& table, const JsonValue& kind) {
  const std::string_view on = kind.key().substr(0, kind.key().size() - 1);  // "nodes": each row is on a node
  for (const JsonValue mass : kind) {
    table.set("on", on).set("name", mass.key());
    if (mass.is_array()) {
      constexpr std::array<const char*, 4> columns{"value", "Ixx", "Iyy", "Izz"};
      std::size_t i = 0;
      for (const JsonValue number : mass) table.set(columns[i++], number);
    } else {
      table.set("value", mass);
    }
    table.end_row();
  }
}

void design_columns(const JsonValue& design, std::set<std::string_view, std::less<>>& columns) {
  if (design.is_text()) {
    columns.insert("design");
    return;
  }
  for (const JsonValue entry : design)
    if (entry.key() != "restraints" || !distances(design)) columns.insert(entry.key());
}

void design_cells(TableText& table, const JsonValue& design) {
  if (design.is_text()) {
    table.set("design", design);
    return;
  }
  for (const JsonValue entry : design) {
    if (!entry.is_array())
      table.set(entry.key(), entry);
    else if (entry.size() == 0)
      table.set(entry.key(), std::string_view("none"));
  }
}

}  // namespace topple::structure::formats
