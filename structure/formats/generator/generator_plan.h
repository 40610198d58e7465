#pragma once
// What a `building` of the file says, before anything is built: the grid and the rules by storey.
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "formats/model_draft.h"

namespace topple::structure::formats {

/// What one `slab` or `wall` object says.
struct PanelRule {
  PanelDraft draft;
  std::vector<std::pair<LoadCaseId, double>> pressures;
  std::vector<std::string> sides;  ///< walls: "x-", "y+", "x2" ...
};

/// Rules by storey, 1 to storeys (0 is not used); none: nothing of that kind is built there.
template <class Rule>
using ByStorey = std::vector<std::optional<Rule>>;

struct BuildingPlan {
  std::string name;                 ///< empty: none
  int nx = 0, ny = 0, storeys = 0;  ///< lines of posts along x and y, counted from 1; levels are counted from 0
  std::vector<double> x, y, z;      ///< places of lines and levels, SI
  ByStorey<MemberDraft> post, beam;
  ByStorey<PanelRule> slab, wall;
  ByStorey<JsonValue> post_value, beam_value, slab_value, wall_value;  ///< where the rules stand

  /// Number of an inner line such as "x2"; 0: it is none.
  [[nodiscard]] int inner_line(const std::string& side) const;
};

/// Throws InputError.
[[nodiscard]] BuildingPlan read_building_plan(const JsonValue& place, const ModelDraft& draft);

}  // namespace topple::structure::formats
