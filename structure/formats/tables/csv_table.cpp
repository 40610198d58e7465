#include "formats/tables/csv_table.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "formats/json/json_document.h"
#include "formats/tables/formula_guard.h"
#include "topple/structure/error.h"
#include "topple/structure/formats/input_place.h"
#include "topple/structure/formats/plain_text.h"

namespace topple::structure {

namespace {

using formats::in_quotes;
using formats::quoted_list;

/// Where the first byte lies that no cell may hold, or npos: what is not UTF-8, and controls but the ends of lines.
std::size_t bad_byte(std::string_view text) {
  if (const std::size_t bad = first_not_utf8(text); bad != std::string_view::npos) return bad;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t found = first_control(text.substr(at));
    if (found == std::string_view::npos) return found;
    if (text[at + found] != '\n' && text[at + found] != '\r') return at + found;
    at += found + 1;
  }
  return std::string_view::npos;
}

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t");
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t") + 1 - begin);
}

/// What the decimal sign of a number can be.
struct DecimalSign {
  bool is_number = false;
  char sign = 0;           ///< '.' or ',' when it has one
  bool ambiguous = false;  ///< "1.234" may be a thousand and more
};

DecimalSign decimal_sign(std::string_view cell) {
  DecimalSign result;
  std::size_t i = !cell.empty() && (cell[0] == '-' || cell[0] == '+') ? 1 : 0;
  const auto digits = [&] {
    const std::size_t begin = i;
    while (i < cell.size() && cell[i] >= '0' && cell[i] <= '9') ++i;
    return i - begin;
  };
  const std::size_t first = i, before = digits();
  std::size_t after = 0;
  if (i < cell.size() && (cell[i] == '.' || cell[i] == ',')) {
    result.sign = cell[i++];
    after = digits();
  }
  if (before + after == 0) return result;
  const bool exponent = i < cell.size() && (cell[i] == 'e' || cell[i] == 'E');
  if (exponent) {
    ++i;
    if (i < cell.size() && (cell[i] == '-' || cell[i] == '+')) ++i;
    if (digits() == 0) return result;
  }
  result.is_number = i == cell.size();
  result.ambiguous = result.sign != 0 && after == 3 && before >= 1 && before <= 3 && cell[first] != '0' && !exponent;
  return result;
}

}  // namespace

CsvTable::CsvTable(std::string whole, std::string name, std::vector<std::string_view> columns)
    : text_(std::move(whole)), name_(std::move(name)), columns_(std::move(columns)) {
  std::string_view text = text_;
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  if (const std::size_t bad = bad_byte(text); bad != std::string_view::npos)
    fail_line(
        static_cast<std::uint32_t>(1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(bad), '\n')),
        first_not_utf8(text) == bad ? "the text is not UTF-8; accepted: a table saved as CSV in UTF-8"
                                    : "a control character; accepted: text");
  const std::string_view header = text.substr(0, text.find('\n'));
  if (header.find(',') == std::string_view::npos)
    separator_ = header.find(';') != std::string_view::npos    ? ';'
                 : header.find('\t') != std::string_view::npos ? '\t'
                                                               : ',';
  std::uint32_t line = 1;
  bool has_header = false;
  while (!text.empty()) {
    const std::uint32_t at = line;
    next_record(text, line);
    if (std::all_of(record_.begin(), record_.end(), [](std::string_view cell) { return cell.empty(); })) continue;
    if (has_header)
      add_row(at);
    else
      read_header();
    has_header = true;
  }
  if (!has_header) fail_line(1, "the table is empty; accepted: a header line with " + quoted_list(columns_));
  find_decimal_sign();
}

void CsvTable::next_record(std::string_view& rest, std::uint32_t& line) {
  record_.clear();
  while (true) {
    const std::size_t begin = rest.find_first_not_of(separator_ == '\t' ? " " : " \t");
    const bool quoted = begin != std::string_view::npos && rest[begin] == '"';
    std::string_view cell;
    if (quoted) {
      rest.remove_prefix(begin + 1);
      cell = quoted_cell(rest, line);
    }
    std::size_t end = 0;
    while (end < rest.size() && rest[end] != separator_ && rest[end] != '\n') ++end;
    std::string_view plain = rest.substr(0, end);
    if (plain.ends_with('\r')) plain.remove_suffix(1);
    const std::string_view outside = trimmed(plain);
    if (quoted && !outside.empty()) fail_line(line, "text after a closing quotation mark; accepted: a separator");
    if (!quoted && outside.find('"') != std::string_view::npos)
      fail_line(line,
                "a quotation mark inside a cell; accepted: the cell in quotation marks, with \"\" for each inside");
    record_.push_back(formats::unguarded(quoted ? cell : outside));
    const bool last = end == rest.size() || rest[end] == '\n';
    rest.remove_prefix(std::min(end + 1, rest.size()));
    if (last) break;
  }
  ++line;
}

std::string_view CsvTable::quoted_cell(std::string_view& rest, std::uint32_t& line) {
  const std::uint32_t start = line;
  std::string_view piece;
  std::string* joined = nullptr;
  while (true) {
    const std::size_t quote = rest.find('"');
    if (quote == std::string_view::npos) fail_line(start, "a quotation mark is not closed; accepted: \"...\"");
    piece = rest.substr(0, quote);
    line += static_cast<std::uint32_t>(std::count(piece.begin(), piece.end(), '\n'));
    rest.remove_prefix(quote + 1);
    const bool doubled = rest.starts_with('"');
    if (doubled && joined == nullptr) joined = &unquoted_.emplace_back();
    if (joined != nullptr) *joined += piece;
    if (!doubled) return joined != nullptr ? std::string_view(*joined) : piece;
    *joined += '"';
    rest.remove_prefix(1);
  }
}

void CsvTable::read_header() {
  for (const std::string_view column : record_) {
    const auto known = std::find(columns_.begin(), columns_.end(), column);
    if (!column.empty() && known == columns_.end())
      fail_line(1, "there is no column " + in_quotes(column) + "; accepted: " + quoted_list(columns_));
    const int index = column.empty() ? -1 : static_cast<int>(known - columns_.begin());
    if (index >= 0 && std::find(column_of_.begin(), column_of_.end(), index) != column_of_.end())
      fail_line(1, "the column " + in_quotes(column) + " stands twice; accepted: each once");
    column_of_.push_back(index);
  }
}

void CsvTable::add_row(std::uint32_t line) {
  if (record_.size() != column_of_.size())
    fail_line(line, std::to_string(record_.size()) + " cells where the header has " +
                        std::to_string(column_of_.size()) +
                        "; accepted: as many as the header (is there a decimal comma, or a comma in a name without "
                        "quotation marks?)");
  const std::size_t first = cells_.size();
  cells_.resize(first + columns_.size());
  for (std::size_t k = 0; k < record_.size(); ++k) {
    if (column_of_[k] >= 0)
      cells_[first + static_cast<std::size_t>(column_of_[k])] = record_[k];
    else if (!record_[k].empty())
      fail_line(line, "found " + in_quotes(record_[k]) + " under no heading; accepted: a name in the header line");
  }
  lines_.push_back(line);
}

/// Only where cells are not separated by commas: which sign the numbers have, from those that can mean one thing alone.
void CsvTable::find_decimal_sign() {
  if (separator_ == ',') return;
  std::size_t comma = cells_.size(), point = comma, doubtful = comma;
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    const DecimalSign sign = decimal_sign(cells_[i]);
    if (!sign.is_number || sign.sign == 0) continue;
    std::size_t& first = sign.sign == ',' ? comma : sign.ambiguous ? doubtful : point;
    first = std::min(first, i);
  }
  const auto refuse = [&](std::size_t cell, const std::string& why) {
    fail(cell / columns_.size(), cell % columns_.size(), "found " + in_quotes(cells_[cell]) + ", " + why);
  };
  decimal_comma_ = comma < cells_.size();
  const std::size_t with_point = std::min(point, doubtful);
  if (decimal_comma_ && with_point < cells_.size())
    refuse(with_point, "where other numbers of the table have a decimal comma; accepted: one decimal sign in a table");
  if (doubtful < cells_.size() && point == cells_.size())
    refuse(doubtful,
           "which may mean a thousand; accepted: cells separated by commas, or a number that means one thing");
}

std::string CsvTable::location(std::size_t row) const { return name_ + ", line " + std::to_string(lines_[row]); }

std::string_view CsvTable::cell(std::size_t row, std::size_t column) const {
  return cells_[row * columns_.size() + column];
}

std::string_view CsvTable::text(std::size_t row, std::size_t column) const {
  const std::string_view found = cell(row, column);
  if (found.empty()) fail(row, column, "the cell is empty; accepted: a value");
  return found;
}

std::optional<double> CsvTable::number(std::size_t row, std::size_t column) const {
  std::string text(cell(row, column));
  if (text.empty()) return std::nullopt;
  const DecimalSign sign = decimal_sign(text);
  if (sign.is_number && sign.sign == ',' && !decimal_comma_)
    fail(row, column,
         "found " + in_quotes(text) + ", a decimal comma in a table separated by commas; accepted: a point");
  if (!sign.is_number) fail(row, column, "found " + in_quotes(text) + "; accepted: a number");
  if (decimal_comma_) std::replace(text.begin(), text.end(), ',', '.');
  const std::size_t plus = text.front() == '+' ? 1 : 0;  // from_chars takes no plus sign
  double value = 0;
  const auto [stop, error] = std::from_chars(text.data() + plus, text.data() + text.size(), value);
  if (error != std::errc() || !std::isfinite(value))
    fail(row, column, "found " + in_quotes(text) + "; accepted: a number that can be held");
  return value;
}

void CsvTable::fail(std::size_t row, std::size_t column, const std::string& what) const {
  throw PlacedInputError({location(row), std::string(columns_[column])}, what);
}

void CsvTable::fail_line(std::uint32_t line, const std::string& what) const {
  throw PlacedInputError({name_ + ", line " + std::to_string(line), {}}, what);
}

}  // namespace topple::structure
