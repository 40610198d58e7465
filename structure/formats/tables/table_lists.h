#pragma once
// Tables whose rows belong together by what they name: openings of panels, restraints of members, diaphragms, masses;
// as lines of a JSON model.
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "formats/tables/csv_table.h"

namespace topple::structure::formats {

/// A line of the JSON text and where its row stands.
struct MadeLine {
  std::string json, place;
};

/// Lists of a table by the part that its first column names; to be asked for each part, then to be told that all have
/// been.
class ListsByPart {
 public:
  /// The value of `openings` of each panel: rows of one opening are its corners in order.
  static ListsByPart of_openings(const CsvTable& table);
  /// The distances in `restraints` of each member.
  static ListsByPart of_restraints(const CsvTable& table);

  /// The list of a part as JSON; empty where it has none.
  [[nodiscard]] std::string of(std::string_view part);
  /// Throws InputError for a part that nobody asked for: `kind` ("panel") says what it should have been.
  void require_all_asked_for(std::string_view kind) const;

 private:
  struct List {
    std::string json;
    std::size_t first_row = 0;
    bool asked_for = false;
  };
  explicit ListsByPart(const CsvTable& table) : table_(&table) {}
  const CsvTable* table_;
  std::map<std::string, List, std::less<>> lists_;
};

/// The values of `diaphragms` and of `masses`, line by line.
[[nodiscard]] std::vector<MadeLine> diaphragm_lines(const CsvTable& table);
[[nodiscard]] std::vector<MadeLine> mass_lines(const CsvTable& table);
/// The values of `cuts`, a row for each.
[[nodiscard]] std::vector<MadeLine> cut_lines(const CsvTable& table);

}  // namespace topple::structure::formats
