#pragma once
// Rows of loads and combinations as lines of a JSON model.
#include <vector>

#include "formats/tables/table_lists.h"

namespace topple::structure::formats {

/// The values of `loads`: rows of one part in one case go together, wherever they stand. Throws InputError with the
/// place in the table.
[[nodiscard]] std::vector<MadeLine> load_lines(const CsvTable& table);
/// The values of `combinations`.
[[nodiscard]] std::vector<MadeLine> combination_lines(const CsvTable& table);

}  // namespace topple::structure::formats
