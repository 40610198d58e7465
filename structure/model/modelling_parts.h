#pragma once
// What checks of models share: names collected for one warning, nodes by their places.
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

#include "topple/structure/building.h"

namespace topple::structure {

inline constexpr std::size_t named_at_most = 3;

/// Collects things of one kind: the first few by name, the rest by number.
class Several {
 public:
  void add(const std::string& what) {
    if (++count_ <= named_at_most) text_ += (count_ > 1 ? "; " : "") + what;
  }
  void report(std::vector<std::string>& warnings, const std::string& meaning) const {
    if (count_ == 0) return;
    const std::string more = count_ > named_at_most ? " and " + std::to_string(count_ - named_at_most) + " more" : "";
    warnings.push_back(text_ + more + ": " + meaning);
  }

 private:
  std::string text_;
  std::size_t count_ = 0;
};

/// Nodes by cubes in space.
class NodeGrid {
 public:
  NodeGrid(const Building& building, double size) : building_(building), size_(size) {
    for (std::size_t n = 0; n < building.nodes.size(); ++n) cells_[key(cell(building.nodes[n].position))].push_back(n);
  }
  /// Hands every node within a cube's side of `place` to `use`, some that are further too.
  template <class Use>
  void near(const Vec3& place, Use use) const {
    const auto middle = cell(place);
    for (int x = -1; x <= 1; ++x)
      for (int y = -1; y <= 1; ++y)
        for (int z = -1; z <= 1; ++z) {
          const auto found = cells_.find(key({middle[0] + x, middle[1] + y, middle[2] + z}));
          if (found == cells_.end()) continue;
          for (const std::size_t n : found->second) use(n);
        }
  }

 private:
  using Cell = std::array<std::int64_t, 3>;
  [[nodiscard]] Cell cell(const Vec3& p) const {
    const auto along = [&](double x) { return static_cast<std::int64_t>(std::floor(x / size_)); };
    return {along(p.x()), along(p.y()), along(p.z())};
  }
  static std::uint64_t key(const Cell& c) {
    std::uint64_t hash = 1469598103934665603ULL;
    for (const std::int64_t i : c) hash = (hash ^ static_cast<std::uint64_t>(i)) * 1099511628211ULL;
    return hash;
  }
  const Building& building_;
  double size_;
  std::unordered_map<std::uint64_t, std::vector<std::size_t>> cells_;
};

}  // namespace topple::structure
