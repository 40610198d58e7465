#include "topple/fracture/voronoi.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace topple::fracture {

namespace {

/// SplitMix64 (Steele, Lea, Flood 2014): the same numbers with every library, which std::uniform_real_distribution is
/// not.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  double unit() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
  }

 private:
  std::uint64_t state_;
};

double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

}  // namespace

VoronoiGrid::VoronoiGrid(const std::array<Vec2, 4>& outline, const VoronoiSettings& settings)
    : outline_(outline.begin(), outline.end()), jitter_(settings.jitter) {
  if (!(settings.cell > 0)) throw std::invalid_argument("voronoi: cell must be above 0");
  if (!(settings.jitter >= 0 && settings.jitter <= 1))
    throw std::invalid_argument("voronoi: jitter must be from 0 to 1");
  for (std::size_t i = 0; i < 4; ++i)
    if (!(cross(outline[(i + 1) % 4] - outline[i], outline[(i + 2) % 4] - outline[(i + 1) % 4]) > 0))
      throw std::invalid_argument("voronoi: the outline must be convex and go counter-clockwise");
  const auto length = [&](std::size_t edge) { return (outline[(edge + 1) % 4] - outline[edge]).norm(); };
  columns_ = std::max(1, static_cast<int>(std::lround((length(0) + length(2)) / 2 / settings.cell)));
  rows_ = std::max(1, static_cast<int>(std::lround((length(1) + length(3)) / 2 / settings.cell)));

  const auto at = [&](double u, double v) {
    return Vec2((1 - v) * ((1 - u) * outline[0] + u * outline[1]) + v * ((1 - u) * outline[3] + u * outline[2]));
  };
  Random random(settings.seed);
  for (int row = 0; row < rows_; ++row)
    for (int column = 0; column < columns_; ++column) {
      const double u = (column + 0.5 + jitter_ * (random.unit() - 0.5)) / columns_;
      const double v = (row + 0.5 + jitter_ * (random.unit() - 0.5)) / rows_;
      sites_.push_back(at(u, v));
    }

  // The map from the grid to the panel stretches every direction by at least min |det J| / max |J|: its determinant is
  // linear and its norm convex, so both bounds are found at the corners. The panel is convex, so a straight line in it
  // has a path in the grid, and no shorter one than this bound allows.
  double least_area = INFINITY, greatest_norm = 0;
  for (std::size_t corner = 0; corner < 4; ++corner) {
    const bool right = corner == 1 || corner == 2, top = corner >= 2;
    const Vec2 along_u = (top ? outline[2] - outline[3] : outline[1] - outline[0]) / columns_;
    const Vec2 along_v = (right ? outline[2] - outline[1] : outline[3] - outline[0]) / rows_;
    least_area = std::min(least_area, cross(along_u, along_v));
    greatest_norm = std::max(greatest_norm, std::sqrt(along_u.squaredNorm() + along_v.squaredNorm()));
  }
  least_stretch_ = least_area / greatest_norm;
}

VoronoiCell VoronoiGrid::make(int index, int& ring) const {
  VoronoiCell cell{site(index), {outline_, {-1, -2, -3, -4}}};
  const int column = index % columns_, row = index / columns_;
  const int farthest_ring = std::max(columns_, rows_);
  for (ring = 1; ring < farthest_ring; ++ring) {
    double reach = 0;
    for (const Vec2& vertex : cell.polygon.vertices) reach = std::max(reach, (vertex - cell.site).norm());
    if ((ring - jitter_) * least_stretch_ > 2 * reach) break;
    for (int dr = -ring; dr <= ring; ++dr)
      for (int dc = -ring; dc <= ring; dc += (std::abs(dr) == ring ? 1 : 2 * ring)) {
        const int r = row + dr, c = column + dc;
        if (r < 0 || r >= rows_ || c < 0 || c >= columns_) continue;
        const int other = r * columns_ + c;
        const Vec2 away = site(other) - cell.site;
        clip(cell.polygon, cell.site + away / 2, away, other);
      }
  }
  return cell;
}

VoronoiCell VoronoiGrid::cell(int index) const {
  int unused = 0;
  return make(index, unused);
}

int VoronoiGrid::rings(int index) const {
  int ring = 0;
  (void)make(index, ring);
  return ring - 1;
}

}  // namespace topple::fracture
