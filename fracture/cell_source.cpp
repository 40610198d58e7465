#include "cell_source.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "random.h"
#include "topple/fracture/local_damage.h"
#include "topple/fracture/quadrilaterals.h"
#include "topple/fracture/voronoi.h"

namespace topple::fracture {

namespace {

/// A grid and a flag for each of its cells.
class GridCells : public CellSource {
 public:
  std::vector<Polygon> broken(const Vec2& at, std::optional<double> radius, double, double, std::uint64_t) override {
    std::vector<int> hit = radius ? within(at, *radius) : std::vector<int>{};
    const int first = holding(at);
    if (first >= 0 && !std::binary_search(hit.begin(), hit.end(), first)) hit.push_back(first);
    std::vector<Polygon> cells;
    for (const int index : hit) {
      if (is_broken_[static_cast<std::size_t>(index)]) continue;
      is_broken_[static_cast<std::size_t>(index)] = true;
      cells.push_back(cell(index));
    }
    return cells;
  }
  [[nodiscard]] std::vector<bool>& broken_cells() override { return is_broken_; }

 protected:
  explicit GridCells(int size) : is_broken_(static_cast<std::size_t>(size), false) {}

 private:
  /// The cell that holds the point, or -1 outside the panel.
  [[nodiscard]] virtual int holding(const Vec2& at) const = 0;
  [[nodiscard]] virtual std::vector<int> within(const Vec2& at, double radius) const = 0;
  [[nodiscard]] virtual Polygon cell(int index) const = 0;

  std::vector<bool> is_broken_;
};

class VoronoiCells final : public GridCells {
 public:
  VoronoiCells(VoronoiGrid grid, Polygon outline)
      : GridCells(grid.size()), grid_(std::move(grid)), outline_(std::move(outline)) {}
  [[nodiscard]] std::unique_ptr<CellSource> clone() const override { return std::make_unique<VoronoiCells>(*this); }

 private:
  [[nodiscard]] int holding(const Vec2& at) const override { return encloses(outline_, at) ? grid_.nearest(at) : -1; }
  [[nodiscard]] std::vector<int> within(const Vec2& at, double radius) const override {
    return grid_.within(at, radius);
  }
  [[nodiscard]] Polygon cell(int index) const override { return grid_.cell(index).polygon.vertices; }

  VoronoiGrid grid_;
  Polygon outline_;
};

class QuadrilateralCells final : public GridCells {
 public:
  explicit QuadrilateralCells(QuadrilateralGrid grid) : GridCells(grid.size()), grid_(std::move(grid)) {}
  [[nodiscard]] std::unique_ptr<CellSource> clone() const override {
    return std::make_unique<QuadrilateralCells>(*this);
  }

 private:
  [[nodiscard]] int holding(const Vec2& at) const override { return grid_.holding(at); }
  [[nodiscard]] std::vector<int> within(const Vec2& at, double radius) const override {
    return grid_.within(at, radius);
  }
  [[nodiscard]] Polygon cell(int index) const override { return grid_.cell(index); }

  QuadrilateralGrid grid_;
};

class LocalCells final : public CellSource {
 public:
  LocalCells(const LocalDamageSettings& settings, std::uint64_t seed) : settings_(settings), seed_(seed) {
    check(settings);
  }
  [[nodiscard]] std::unique_ptr<CellSource> clone() const override { return std::make_unique<LocalCells>(*this); }
  [[nodiscard]] std::vector<bool>& broken_cells() override { return none_; }

  std::vector<Polygon> broken(const Vec2& at, std::optional<double> radius, double nearest, double farthest,
                              std::uint64_t number) override {
    const double scale = radius ? *radius / settings_.length[1] : 1.0;
    if (!(scale > 0)) return {};
    Random random(seed_ ^ (number * 0xd1342543de82ef95u));  // a stream of its own for every hit
    return local_damage(at, scale, settings_, random.bits(), nearest, farthest).cells;
  }

 private:
  LocalDamageSettings settings_;
  std::uint64_t seed_;
  std::vector<bool> none_;  ///< broken_cells()
};

}  // namespace

std::unique_ptr<CellSource> make_cell_source(const PanelShape& shape, const PanelSettings& settings) {
  if (settings.method == Method::local) return std::make_unique<LocalCells>(settings.local, settings.seed);
  if (shape.outline.size() != 4) throw std::invalid_argument("the outline must have four corners for this method");
  const std::array<Vec2, 4> corners{shape.outline[0], shape.outline[1], shape.outline[2], shape.outline[3]};
  if (settings.method == Method::voronoi)
    return std::make_unique<VoronoiCells>(
        VoronoiGrid(corners, {settings.cell, settings.jitter.value_or(1.0), settings.seed}), shape.outline);
  return std::make_unique<QuadrilateralCells>(
      QuadrilateralGrid(corners, {settings.cell, settings.jitter.value_or(0.5), settings.seed}));
}

}  // namespace topple::fracture
