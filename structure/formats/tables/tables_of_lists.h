#pragma once
// Lists within the parts of a JSON model as tables of their own, and `design` of members as columns.
#include <set>
#include <string_view>

#include "formats/tables/table_text.h"

namespace topple::structure::formats {

/// Rows of restraints.csv from a member, of openings.csv from a panel.
void restraint_rows(TableText& table, const JsonValue& member);
void opening_rows(TableText& table, const JsonValue& panel);
/// Rows of diaphragms.csv from one diaphragm, of masses.csv from `nodes`, `members` or `loads` of the masses.
void diaphragm_rows(TableText& table, const JsonValue& diaphragm);
void mass_rows(TableText& table, const JsonValue& kind);

/// The columns of members.csv that hold a member's `design`, and its cells there.
void design_columns(const JsonValue& design, std::set<std::string_view, std::less<>>& columns);
void design_cells(TableText& table, const JsonValue& design);

}  // namespace topple::structure::formats
