#include "strip_pieces.h"

#include <algorithm>

namespace topple::structure {

namespace {

// Gauss-Legendre on [0, 1]; four points across the strip, three along it.
constexpr std::array<double, 4> across_place{0.06943184420297371, 0.33000947820757187, 0.66999052179242813,
                                             0.93056815579702629};
constexpr std::array<double, 4> across_weight{0.17392742256872693, 0.32607257743127307, 0.32607257743127307,
                                              0.17392742256872693};
constexpr std::array<double, 3> along_place{0.11270166537925831, 0.5, 0.88729833462074169};
constexpr std::array<double, 3> along_weight{5.0 / 18, 8.0 / 18, 5.0 / 18};

/// A side of a polygon that crosses a slab: u at both cuts.
struct Crossing {
  double first = 0, last = 0;
  std::size_t side = 0;
};

template <class Polygon>
std::vector<Crossing> crossings(const Polygon& polygon, const StripAxes& axes, double from, double to) {
  std::vector<Crossing> result;
  const std::size_t n = polygon.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Vec2 &a = polygon[i], &b = polygon[(i + 1) % n];
    const double ta = axes.t(a), tb = axes.t(b);
    if (std::min(ta, tb) > from || std::max(ta, tb) < to) continue;
    const auto u = [&](double t) { return axes.u(a) + (axes.u(b) - axes.u(a)) * ((t - ta) / (tb - ta)); };
    result.push_back({u(from), u(to), i});
  }
  std::sort(result.begin(), result.end(),
            [](const Crossing& x, const Crossing& y) { return x.first + x.last < y.first + y.last; });
  return result;
}

void add_points(const StripAxes& axes, Slab& slab, const Crossing& low, const Crossing& high, double sign) {
  for (std::size_t i = 0; i < across_place.size(); ++i) {
    const double f = across_place[i], t = slab.from + f * (slab.to - slab.from);
    const double u0 = low.first + f * (low.last - low.first), u1 = high.first + f * (high.last - high.first);
    for (std::size_t j = 0; j < along_place.size(); ++j) {
      const double u = u0 + along_place[j] * (u1 - u0);
      const double area = (slab.to - slab.from) * (u1 - u0) * across_weight[i] * along_weight[j];
      slab.points.push_back({u * axes.along + t * axes.across, sign * area, f});
    }
  }
}

}  // namespace

std::vector<Slab> cut_into_slabs(const PanelOutline& outline, const StripAxes& axes, std::vector<double> cuts) {
  double least = axes.t(outline.corner[0]), greatest = least;
  for (const Vec2& corner : outline.corner) {
    cuts.push_back(axes.t(corner));
    least = std::min(least, cuts.back());
    greatest = std::max(greatest, cuts.back());
  }
  for (const auto& opening : outline.openings)
    for (const Vec2& point : opening) cuts.push_back(axes.t(point));
  for (double& cut : cuts) cut = std::clamp(cut, least, greatest);
  std::sort(cuts.begin(), cuts.end());
  cuts.erase(std::unique(cuts.begin(), cuts.end()), cuts.end());
  constexpr double negligible = 1e-14;  // of the size: thinner slabs come from rounding of parallel sides
  std::vector<Slab> slabs;
  for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
    Slab slab;
    slab.from = cuts[i];
    slab.to = cuts[i + 1];
    if (slab.to - slab.from < negligible * outline.size()) continue;
    const auto bounds = crossings(outline.corner, axes, slab.from, slab.to);
    if (bounds.size() < 2) continue;
    slab.edges = {bounds.front().side, bounds.back().side};
    add_points(axes, slab, bounds.front(), bounds.back(), 1);
    for (const auto& opening : outline.openings) {
      const auto sides = crossings(opening, axes, slab.from, slab.to);
      for (std::size_t k = 0; k + 1 < sides.size(); k += 2) add_points(axes, slab, sides[k], sides[k + 1], -1);
    }
    slabs.push_back(std::move(slab));
  }
  return slabs;
}

}  // namespace topple::structure
