#pragma once
// Which parts of the building lie near a place: a uniform grid over their bounds, built once.
#include <span>
#include <vector>

#include "simulation/debris/part_shapes.h"

namespace topple::structure {

class PartGrid {
 public:
  PartGrid(const Building& building, const PartShapes& shapes);

  /// Parts whose bounds meet the box, in order of number; `passed_over` (by number, or empty): those that are not asked
  /// for.
  [[nodiscard]] std::vector<Part> near(const Bounds& box, std::span<const char> passed_over = {}) const;
  /// Bounds of everything.
  [[nodiscard]] const Bounds& bounds() const { return bounds_; }

 private:
  struct Range {
    std::array<int, 3> first, last;
  };
  [[nodiscard]] Range cells_of(const Bounds& box) const;
  template <class Visit>
  void visit(const Range& range, const Visit& visit) const;

  const Building& building_;
  const PartShapes& shapes_;
  Bounds bounds_;
  double cell_ = 1;
  std::array<int, 3> counts_{1, 1, 1};
  std::vector<std::vector<std::int32_t>> cells_;
};

}  // namespace topple::structure
