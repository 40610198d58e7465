// Reads what shakes the ground or lets loads grow and fade: a CSV file with a column for the time.
#include <algorithm>
#include <array>
#include <cmath>

#include "formats/model_files.h"
#include "formats/tables/csv_table.h"
#include "topple/structure/error.h"
#include "topple/structure/formats/plain_text.h"
#include "topple/structure/motion.h"
#include "topple/structure/number_range.h"
#include "topple/structure/time_history.h"

namespace topple::structure {
namespace {

constexpr std::array<std::string_view, 3> ground{"ax", "ay", "az"};

/// What is accepted of a column, in SI: accelerations as of gravity (ranges::gravity), factors of load cases.
constexpr NumberRange acceleration{-1e5, 1e5}, factor{-1e6, 1e6};
constexpr const NumberRange& range_of(const TimeHistory::Series& series) {
  return series.axis >= 0 ? acceleration : factor;
}

/// The header's cells, to be known before the table is read; quotation marks are not needed in them.
std::vector<std::string> header_of(const std::string& text) {
  std::string_view line = std::string_view(text).substr(0, text.find_first_of("\r\n"));
  if (line.starts_with("\xEF\xBB\xBF")) line.remove_prefix(3);
  const char separator = line.find(';') != line.npos ? ';' : line.find('\t') != line.npos ? '\t' : ',';
  std::vector<std::string> cells;
  while (true) {
    const std::size_t end = line.find(separator);
    std::string_view cell = line.substr(0, end);
    while (!cell.empty() && (cell.front() == ' ' || cell.front() == '"')) cell.remove_prefix(1);
    while (!cell.empty() && (cell.back() == ' ' || cell.back() == '"')) cell.remove_suffix(1);
    cells.emplace_back(cell);
    if (end == line.npos) return cells;
    line.remove_prefix(end + 1);
  }
}

std::string accepted(const Building& building) {
  std::string names = "time, ax, ay, az";
  for (const LoadCase& load_case : building.cases) names += ", " + load_case.name;
  return names;
}

TimeHistory::Series series_of(const std::string& place, const std::string& column, const Building& building) {
  TimeHistory::Series series;
  const auto axis = std::find(ground.begin(), ground.end(), column);
  for (std::size_t k = 0; k < building.cases.size(); ++k)
    if (building.cases[k].name == column) series.load_case = LoadCaseId(k);
  if (series.load_case.valid()) return series;
  if (axis == ground.end())
    throw InputError(place + ": column \"" + one_line(column) + "\"; accepted: " + accepted(building));
  series.axis = static_cast<int>(axis - ground.begin());
  return series;
}

}  // namespace

TimeHistory read_time_history(const std::string& path, const Building& building) {
  std::string text = formats::whole_text(path);
  const std::vector<std::string> names = header_of(text);
  if (names.empty() || names[0] != "time")
    throw InputError(path + ", line 1: the first column is \"" + (names.empty() ? "" : one_line(names[0])) +
                     "\"; accepted: time (s)");
  if (names.size() < 2) throw InputError(path + ", line 1: no column beside time; accepted: " + accepted(building));
  TimeHistory history;
  history.file = path;
  for (std::size_t k = 1; k < names.size(); ++k)
    history.series.push_back(series_of(path + ", line 1", names[k], building));
  const std::vector<std::string_view> columns(names.begin(), names.end());
  const CsvTable table(std::move(text), path, columns);
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const auto number = [&](std::size_t column) {
      const std::optional<double> value = table.number(row, column);
      if (!value) table.fail(row, column, "no number; accepted: a number in every cell");
      return *value;
    };
    const double time = number(0);
    if (!ranges::instant.contains(time)) table.fail(row, 0, "accepted: " + ranges::instant.text());
    if (!history.times.empty() && time <= history.times.back())
      table.fail(row, 0, "times start at 0 or later and ascend");
    history.times.push_back(time);
    for (std::size_t k = 0; k < history.series.size(); ++k) {
      const double unit = history.series[k].axis >= 0 ? building.units.length : 1;
      const double value = number(k + 1) * unit;
      const NumberRange& range = range_of(history.series[k]);
      if (!range.contains(value)) table.fail(row, k + 1, "accepted (in SI): " + range.text());
      history.series[k].values.push_back(value);
    }
  }
  if (history.times.size() < 2)
    throw InputError(path + ": fewer than two rows; accepted: two times at least, later than 0 at the end");
  return history;
}

TimeHistory make_time_history(const std::map<std::string, std::vector<double>>& columns, const Building& building) {
  const std::string place = "time history";
  const auto times = columns.find("time");
  if (times == columns.end() || columns.size() < 2)
    throw InputError(place + ": no column time, or none beside it; accepted: " + accepted(building));
  TimeHistory history;
  history.file = place;
  history.times = times->second;
  for (std::size_t i = 0; i < history.times.size(); ++i)
    if (!ranges::instant.contains(history.times[i]) || (i > 0 && history.times[i] <= history.times[i - 1]))
      throw InputError(place + ", time[" + std::to_string(i) + "]: times start at 0 or later and ascend");
  if (history.times.size() < 2)
    throw InputError(place + ": fewer than two times; accepted: two at least, later than 0 at the end");
  for (const auto& [name, values] : columns) {
    if (name == "time") continue;
    TimeHistory::Series series = series_of(place, name, building);
    if (values.size() != history.times.size())
      throw InputError(place + ", " + name + ": " + std::to_string(values.size()) +
                       " numbers; accepted: one for each of " + std::to_string(history.times.size()) + " times");
    const NumberRange& range = range_of(series);
    if (!std::all_of(values.begin(), values.end(), [&](double value) { return range.contains(value); }))
      throw InputError(place + ", " + name + ": a number out of range; accepted: " + range.text());
    series.values = values;
    history.series.push_back(std::move(series));
  }
  return history;
}

}  // namespace topple::structure
