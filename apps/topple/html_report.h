#pragma once
#include <string>

#include "topple/structure/member_checks.h"

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

/// The self-contained page: model, results (the text of results.json) and diagrams in one file that needs no network.
/// Throws std::runtime_error when the program was built without the page.
[[nodiscard]] std::string html_report(const structure::Building& building, const structure::AnalysisResult& result,
                                      const std::string& results_json, const ReportCover& cover = {});

}  // namespace topple::app
