#pragma once
// The three methods behind one question: which convex or concave cells does a hit break?
#include <memory>
#include <optional>
#include <vector>

#include "topple/fracture/panel.h"

namespace topple::fracture {

class CellSource {
 public:
  virtual ~CellSource() = default;
  /// Cells that hit number `number` breaks and that no earlier one broke; they may reach over the border, do not
  /// overlap, and go counter-clockwise. Nothing nearer to the point or farther from it than the given distances (m) is
  /// panel.
  virtual std::vector<Polygon> broken(const Vec2& at, std::optional<double> radius, double nearest, double farthest,
                                      std::uint64_t number) = 0;
  [[nodiscard]] virtual std::unique_ptr<CellSource> clone() const = 0;
  /// All that hits change: whether each cell is broken. Empty for a method that makes its cells anew for each hit.
  [[nodiscard]] virtual std::vector<bool>& broken_cells() = 0;
};

/// Throws std::invalid_argument when the settings or the outline do not suit the method.
[[nodiscard]] std::unique_ptr<CellSource> make_cell_source(const PanelShape& shape, const PanelSettings& settings);

}  // namespace topple::fracture
