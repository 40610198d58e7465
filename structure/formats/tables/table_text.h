#pragma once
// A table as it is written, and how what tables cannot hold is refused.
#include <algorithm>
#include <charconv>
#include <string>
#include <string_view>
#include <vector>

#include "formats/json/json_document.h"
#include "formats/tables/formula_guard.h"
#include "formats/tables/model_tables.h"

namespace topple::structure::formats {

[[noreturn]] inline void refuse(const JsonValue& value, const std::string& instead) {
  value.fail("tables cannot hold it; accepted for them: " + instead);
}

inline void hold_only(const JsonValue& object, const std::vector<std::string_view>& keys, const std::string& instead) {
  for (const JsonValue value : object)
    if (std::find(keys.begin(), keys.end(), value.key()) == keys.end()) refuse(value, instead);
}

/// A table as it is written: cells by column name.
class TableText {
 public:
  explicit TableText(model_tables::Columns columns) : columns_(std::move(columns)), cells_(columns_.size()) {
    for (const std::string_view column : columns_) text_ += (text_.empty() ? "" : ",") + std::string(column);
    text_ += '\n';
  }
  TableText& set(std::string_view column, std::string_view given) {
    const std::string text = guarded(given);
    std::string& cell = cells_[index(column)];
    const bool plain =
        text.find_first_of(",\"\n\r;\t") == std::string::npos && !text.starts_with(' ') && !text.ends_with(' ');
    cell = plain ? text : "\"";
    if (plain) return *this;
    for (const char c : text) cell += c == '"' ? std::string("\"\"") : std::string(1, c);
    cell += '"';
    return *this;
  }
  TableText& set(std::string_view column, double number) {
    char digits[32];
    cells_[index(column)].assign(digits, std::to_chars(digits, digits + sizeof digits, number).ptr);
    return *this;
  }
  TableText& set(std::string_view column, const JsonValue& value) {
    if (value.is_number()) return set(column, value.number());
    if (value.is_bool()) return set(column, std::string_view(value.boolean() ? "true" : "false"));
    return set(column, value.text());
  }
  void end_row() {
    for (std::size_t c = 0; c < cells_.size(); ++c) {
      if (c > 0) text_ += ',';
      text_ += cells_[c];
      cells_[c].clear();
    }
    text_ += '\n';
    ++rows_;
  }
  [[nodiscard]] std::size_t rows() const { return rows_; }
  [[nodiscard]] std::string release() { return std::move(text_); }

 private:
  [[nodiscard]] std::size_t index(std::string_view column) const {
    return static_cast<std::size_t>(std::find(columns_.begin(), columns_.end(), column) - columns_.begin());
  }
  model_tables::Columns columns_;
  std::vector<std::string> cells_;
  std::string text_;
  std::size_t rows_ = 0;
};

}  // namespace topple::structure::formats
