#pragma once
#include "topple/structure/analysis.h"

namespace topple::structure {

/// Levels of a building: the distinct heights of its posts' ends. Storey k (from 0) ends at level k + 1.
class Storeys {
 public:
  explicit Storeys(const Building& building);
  [[nodiscard]] std::size_t count() const { return levels_.empty() ? 0 : levels_.size() - 1; }
  /// Drift: the largest horizontal displacement difference over height of any post that ends at the level; shear: what
  /// its posts hand down to the level below, global x and y.
  [[nodiscard]] std::vector<StoreyResult> results(const std::vector<Vec6>& displacements,
                                                  const std::vector<MemberResult>& members) const;

 private:
  const Building& building_;
  std::vector<double> levels_;
  std::vector<int> storey_of_;  ///< per member, -1 where it is no post
};

}  // namespace topple::structure
