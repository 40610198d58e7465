#pragma once
// A part of results.json: of a large model, what a page can show.
#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "topple/structure/analysis.h"

namespace topple::structure {

/// Which members and nodes are written, in ascending order. Supports, panels, storeys and what concerns the whole are
/// written all the same; of joints those of the members that are.
struct ResultsSelection {
  std::vector<std::size_t> members;  ///< ascending, into Building::members
  std::vector<std::size_t> nodes;    ///< ascending, into Building::nodes
};

/// Of every section the members that are used most over all combinations (with design checks; else the first ones), at
/// most `of_section` of each, and evenly many of the others up to `count` in all; with the nodes at their ends and
/// those that are supported.
[[nodiscard]] ResultsSelection select_members(const Building& building, const AnalysisResult& result, std::size_t count,
                                              std::size_t of_section);

/// As results_json() of the whole.
[[nodiscard]] std::string results_json(const Building& building, const AnalysisRequest& request,
                                       const AnalysisResult& result, const std::map<std::string, double>& seconds,
                                       const ResultsSelection& selection);

}  // namespace topple::structure
