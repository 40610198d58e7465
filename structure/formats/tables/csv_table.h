#pragma once
// One table of a model: a CSV text with a header line. Cells are separated by commas, or, as spreadsheets write where
// the decimal sign is a comma, by semicolons or tabs. Numbers are never misread: what could mean two things is refused.
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace topple::structure {

class CsvTable {
 public:
  /// `name` stands for the file in messages ("folder/nodes.csv"). Throws InputError with the line: for a header that
  /// names something else than `columns`, or one twice, for rows with more or fewer cells than the header, for text
  /// that is not UTF-8.
  CsvTable(std::string text, std::string name, std::vector<std::string_view> columns);
  CsvTable(const CsvTable&) = delete;
  CsvTable& operator=(const CsvTable&) = delete;

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] std::size_t rows() const { return lines_.size(); }
  /// "folder/nodes.csv, line 5"
  [[nodiscard]] std::string location(std::size_t row) const;

  /// The cell's text; empty: the key is absent.
  [[nodiscard]] std::string_view cell(std::size_t row, std::size_t column) const;
  /// The same for a cell that must not be empty.
  [[nodiscard]] std::string_view text(std::size_t row, std::size_t column) const;
  /// A finite number; none for an empty cell.
  [[nodiscard]] std::optional<double> number(std::size_t row, std::size_t column) const;

  /// Throws InputError: place, column, `what`.
  [[noreturn]] void fail(std::size_t row, std::size_t column, const std::string& what) const;

 private:
  /// Puts the cells of the record at the front of `rest`, which it leaves, into record_; `line` moves on.
  void next_record(std::string_view& rest, std::uint32_t& line);
  /// A cell that begins with a quotation mark, up to its closing one.
  std::string_view quoted_cell(std::string_view& rest, std::uint32_t& line);
  void read_header();
  void add_row(std::uint32_t line);
  void find_decimal_sign();
  [[noreturn]] void fail_line(std::uint32_t line, const std::string& what) const;

  std::string text_, name_;
  std::deque<std::string> unquoted_;  ///< cells that held doubled quotation marks
  std::vector<std::string_view> columns_, record_;
  std::vector<int> column_of_;           ///< of the file's cells: index in columns_, -1: a nameless one, always empty
  std::vector<std::string_view> cells_;  ///< row by row, columns_.size() each, in text_ or unquoted_
  std::vector<std::uint32_t> lines_;     ///< of each row
  char separator_ = ',';
  bool decimal_comma_ = false;
};

}  // namespace topple::structure
