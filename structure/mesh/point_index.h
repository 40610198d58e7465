#pragma once
// Points by place: which one lies here?
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <utility>
#include <vector>

#include "topple/structure/building.h"

namespace topple::structure {

/// Finds the nearest of the points added, within a tolerance of at most `reach`.
class PointIndex {
 public:
  explicit PointIndex(double reach) : cell_(4 * reach) {}

  void add(const Vec3& place, int id) { cells_[key(cell_of(place))].emplace_back(place, id); }

  /// The nearest within the tolerance, of equally near ones the one added first; -1: none.
  [[nodiscard]] int nearest(const Vec3& place, double tolerance) const {
    const Cell centre = cell_of(place);
    int found = -1;
    double least = tolerance;
    for (std::int64_t x = -1; x <= 1; ++x)
      for (std::int64_t y = -1; y <= 1; ++y)
        for (std::int64_t z = -1; z <= 1; ++z) {
          const auto cell = cells_.find(key({centre[0] + x, centre[1] + y, centre[2] + z}));
          if (cell == cells_.end()) continue;
          for (const auto& [point, id] : cell->second) {
            const double distance = (point - place).norm();
            if (distance < least || (found < 0 && distance <= least)) {
              found = id;
              least = distance;
            }
          }
        }
    return found;
  }

 private:
  using Cell = std::array<std::int64_t, 3>;
  [[nodiscard]] Cell cell_of(const Vec3& p) const {
    return {std::llround(p.x() / cell_), std::llround(p.y() / cell_), std::llround(p.z() / cell_)};
  }
  /// Different cells may share a key: their points are told apart by distance.
  [[nodiscard]] static std::uint64_t key(const Cell& c) {
    return static_cast<std::uint64_t>(c[0]) * 73856093u ^ static_cast<std::uint64_t>(c[1]) * 19349669u ^
           static_cast<std::uint64_t>(c[2]) * 83492791u;
  }

  double cell_;
  std::unordered_map<std::uint64_t, std::vector<std::pair<Vec3, int>>> cells_;
};

}  // namespace topple::structure
