#pragma once
#include <string>

#include "topple/structure/member_checks.h"
#include "topple/structure/results_selection.h"

namespace topple::app {

/// Stations along each member that the report's diagrams are drawn through: ask for at least this many.
inline constexpr int report_stations = 10;

/// What the cover says beside the model, and how the checks were made.
struct ReportCover {
  std::string project, author;
  structure::DesignInput design;
};

/// True when this program was built with the report page (npm was there).
[[nodiscard]] bool can_write_report();

/// A building of more members is shown by a selection of them, the others as lines: a page of hundreds of megabytes
/// opens nowhere.
inline constexpr std::size_t most_members_whole = 5000, members_selected = 2400, selected_of_section = 40;

/// The self-contained page: model, results (the text of results.json, of the same selection) and diagrams in one file
/// that needs no network. `selection`: null when every member is there. Throws std::runtime_error when the program was
/// built without the page.
[[nodiscard]] std::string html_report(const structure::Building& building, const structure::AnalysisResult& result,
                                      const std::string& results_json, const ReportCover& cover = {},
                                      const structure::ResultsSelection* selection = nullptr);

}  // namespace topple::app
