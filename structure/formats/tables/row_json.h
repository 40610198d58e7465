#pragma once
// Cells of a row as JSON.
#include <algorithm>
#include <string>
#include <string_view>

#include "formats/json/json_writer.h"
#include "formats/tables/csv_table.h"

namespace topple::structure::formats {

/// A string of the JSON text.
inline std::string json_text(std::string_view text) {
  const bool plain = std::all_of(text.begin(), text.end(),
                                 [](char c) { return c != '"' && c != '\\' && static_cast<unsigned char>(c) >= 0x20; });
  if (!plain) return JsonWriter().value(text).release();
  std::string result;
  result.reserve(text.size() + 2);
  result += '"';
  result += text;
  result += '"';
  return result;
}

/// A number that must be there: throws InputError where its cell is empty.
inline std::string needed(const CsvTable& table, std::size_t row, std::size_t column) {
  (void)table.text(row, column);
  return json_number(*table.number(row, column));
}

}  // namespace topple::structure::formats
