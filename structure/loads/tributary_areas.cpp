#include "tributary_areas.h"

#include <algorithm>
#include <cmath>

#include "strip_pieces.h"

namespace topple::structure {

namespace {

double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

/// value + slope * s
struct Line {
  double value = 0, slope = 0;
  [[nodiscard]] double at(double s) const { return value + slope * s; }
};

/// Breadth of what belongs to an edge, as far as each of the other three edges bounds it: the distance at which the
/// other edge is as near.
std::vector<Line> bounds_of_breadth(const PanelOutline& outline, std::size_t edge) {
  const Vec2 along = outline.along(edge);
  std::vector<Line> lines;
  for (std::size_t k = 1; k < 4; ++k) {
    const Vec2 other = outline.along(edge + k);
    // Cosine between the two inward normals, which is that between the edges.
    const double room = 1 - along.dot(other);
    lines.push_back({cross(other, outline.at(edge) - outline.at(edge + k)) / room, cross(other, along) / room});
  }
  return lines;
}

std::size_t least_at(const std::vector<Line>& lines, double s) {
  std::size_t least = 0;
  for (std::size_t i = 1; i < lines.size(); ++i)
    if (lines[i].at(s) < lines[least].at(s)) least = i;
  return least;
}

std::vector<TributaryStrip> lower_envelope(const std::vector<Line>& lines, double length) {
  std::vector<double> breaks{0, length};
  for (std::size_t i = 0; i < lines.size(); ++i)
    for (std::size_t j = i + 1; j < lines.size(); ++j) {
      const double s = (lines[j].value - lines[i].value) / (lines[i].slope - lines[j].slope);
      if (s > 0 && s < length) breaks.push_back(s);
    }
  std::sort(breaks.begin(), breaks.end());
  std::vector<TributaryStrip> shares;
  std::size_t before = lines.size();
  for (std::size_t k = 0; k + 1 < breaks.size(); ++k) {
    if (!(breaks[k] < breaks[k + 1])) continue;
    const std::size_t least = least_at(lines, 0.5 * (breaks[k] + breaks[k + 1]));
    if (least == before) {
      shares.back().to = breaks[k + 1];
      shares.back().last = lines[least].at(breaks[k + 1]);
    } else {
      shares.push_back({breaks[k], breaks[k + 1], lines[least].at(breaks[k]), lines[least].at(breaks[k + 1])});
    }
    before = least;
  }
  return shares;
}

/// Distance from the edge's first corner at which the line t crosses it.
double position_on_edge(const PanelOutline& outline, const StripAxes& axes, std::size_t edge, double t) {
  const double ta = axes.t(outline.at(edge)), tb = axes.t(outline.at(edge + 1));
  return std::clamp((t - ta) / (tb - ta), 0.0, 1.0) * outline.length(edge);
}

void keep(std::vector<TributaryStrip>& shares, const ShareCollector& collector) {
  if (!collector.empty()) shares.push_back(collector.share());
}

/// The point x lies at the fraction `ratio` of the line from the place `fraction` on the edge to the same fraction on
/// its opposite.
struct RuledPlace {
  double fraction = 0.5, ratio = 0.5;
};

RuledPlace ruled_place(const PanelOutline& outline, std::size_t edge, const Vec2& x) {
  const Vec2 &a = outline.at(edge), &b = outline.at(edge + 1), &c = outline.at(edge + 2), &d = outline.at(edge + 3);
  RuledPlace place;
  constexpr int most = 50;  // Newton's method; a convex outline takes three to six
  for (int i = 0; i < most; ++i) {
    const double s = place.fraction, r = place.ratio;
    const Vec2 residual = x - ((1 - r) * (a + s * (b - a)) + r * (d + s * (c - d)));
    const Vec2 by_s = (1 - r) * (b - a) + r * (c - d), by_r = (d - a) + s * ((c - d) - (b - a));
    const double determinant = cross(by_s, by_r);
    const double ds = cross(residual, by_r) / determinant, dr = cross(by_s, residual) / determinant;
    place.fraction = std::clamp(s + ds, 0.0, 1.0);
    place.ratio = std::clamp(r + dr, 0.0, 1.0);
    if (std::abs(ds) + std::abs(dr) < 1e-15) break;
  }
  return place;
}

TributaryAreas solid_edge_pair_areas(const PanelOutline& outline, std::size_t edge) {
  const Vec2 &a = outline.at(edge), &b = outline.at(edge + 1), &c = outline.at(edge + 2), &d = outline.at(edge + 3);
  // Jacobian of the ruled map, linear in both of its parameters, at its corners.
  const double ja = cross(b - a, d - a), jb = cross(b - a, c - b), jd = cross(c - d, d - a), jc = jb + jd - ja;
  const double near = outline.length(edge), far = outline.length(edge + 2);
  TributaryAreas shares;
  shares[edge] = {{0, near, (ja / 3 + jd / 6) / near, (jb / 3 + jc / 6) / near}};
  shares[edge + 2] = {{0, far, (jb / 6 + jc / 3) / far, (ja / 6 + jd / 3) / far}};
  return shares;
}

/// Fractions of the edge between which shares are gathered. In a parallelogram the strips are the slabs; else an even
/// division is as good as any.
std::vector<double> gathering_bounds(const PanelOutline& outline, std::size_t edge, bool parallelogram) {
  std::vector<double> bounds{0, 1};
  if (parallelogram) {
    for (const auto& opening : outline.openings)
      for (const Vec2& point : opening) bounds.push_back(ruled_place(outline, edge, point).fraction);
    std::sort(bounds.begin(), bounds.end());
    bounds.erase(std::unique(bounds.begin(), bounds.end()), bounds.end());
    return bounds;
  }
  constexpr int divisions = 8;
  bounds.clear();
  for (int i = 0; i <= divisions; ++i) bounds.push_back(static_cast<double>(i) / divisions);
  return bounds;
}

}  // namespace

double PanelOutline::size() const { return std::max((corner[2] - corner[0]).norm(), (corner[3] - corner[1]).norm()); }

TributaryAreas two_way_areas(const PanelOutline& outline) {
  TributaryAreas shares;
  for (std::size_t edge = 0; edge < 4; ++edge)
    shares[edge] = lower_envelope(bounds_of_breadth(outline, edge), outline.length(edge));
  return shares;
}

TributaryAreas strip_areas(const PanelOutline& outline, const Vec2& direction) {
  const StripAxes axes(direction);
  TributaryAreas shares;
  for (const Slab& slab : cut_into_slabs(outline, axes)) {
    const auto stretch = [&](std::size_t edge) {
      return ShareCollector(position_on_edge(outline, axes, edge, slab.from),
                            position_on_edge(outline, axes, edge, slab.to));
    };
    ShareCollector low = stretch(slab.edges[0]), high = stretch(slab.edges[1]);
    for (const AreaPoint& point : slab.points) {
      const double t = slab.from + point.fraction * (slab.to - slab.from);
      const auto u_of = [&](std::size_t edge) {
        return axes.u(outline.at(edge) + position_on_edge(outline, axes, edge, t) * outline.along(edge));
      };
      const double u0 = u_of(slab.edges[0]), u1 = u_of(slab.edges[1]);
      const double ratio = (axes.u(point.point) - u0) / (u1 - u0);
      low.add(point.fraction, (1 - ratio) * point.weight);
      high.add(point.fraction, ratio * point.weight);
    }
    keep(shares[slab.edges[0]], low);
    keep(shares[slab.edges[1]], high);
  }
  return shares;
}

TributaryAreas edge_pair_areas(const PanelOutline& outline, std::size_t edge) {
  if (outline.openings.empty()) return solid_edge_pair_areas(outline, edge);
  const std::size_t opposite = edge + 2;
  const Vec2 skew = outline.at(0) - outline.at(1) + outline.at(2) - outline.at(3);
  const bool parallelogram = skew.norm() < 1e-9 * outline.size();
  const StripAxes axes(parallelogram ? Vec2(outline.at(edge + 3) - outline.at(edge))
                                     : Vec2(outline.middle(opposite) - outline.middle(edge)));
  std::vector<double> cuts;
  constexpr int fine = 32;  // slabs, so that no stretch of an edge goes without area points
  if (!parallelogram)
    for (int i = 1; i < fine; ++i) {
      const double f = static_cast<double>(i) / fine;
      cuts.push_back(axes.t(outline.at(edge) + f * (outline.at(edge + 1) - outline.at(edge))));
    }
  const std::vector<double> bounds = gathering_bounds(outline, edge, parallelogram);
  const double near = outline.length(edge), far = outline.length(opposite);
  std::vector<ShareCollector> on_near, on_far;
  for (std::size_t i = 0; i + 1 < bounds.size(); ++i) {
    on_near.emplace_back(bounds[i] * near, bounds[i + 1] * near);
    on_far.emplace_back((1 - bounds[i]) * far, (1 - bounds[i + 1]) * far);
  }
  for (const Slab& slab : cut_into_slabs(outline, axes, cuts))
    for (const AreaPoint& point : slab.points) {
      const RuledPlace place = ruled_place(outline, edge, point.point);
      const auto above = std::upper_bound(bounds.begin() + 1, bounds.end() - 1, place.fraction);
      const auto bin = static_cast<std::size_t>(above - bounds.begin()) - 1;
      const double within = (place.fraction - bounds[bin]) / (bounds[bin + 1] - bounds[bin]);
      on_near[bin].add(within, (1 - place.ratio) * point.weight);
      on_far[bin].add(within, place.ratio * point.weight);
    }
  TributaryAreas shares;
  for (const ShareCollector& collector : on_near) keep(shares[edge], collector);
  for (const ShareCollector& collector : on_far) keep(shares[opposite], collector);
  return shares;
}

VerticalAreas vertical_areas(const PanelOutline& outline, std::size_t edge, const Vec2& up) {
  const StripAxes axes(up);
  const double ta = axes.t(outline.at(edge)), tb = axes.t(outline.at(edge + 1));
  const double low = std::min(ta, tb), high = std::max(ta, tb);
  // A steeper edge has nothing above it worth telling apart.
  constexpr double least_breadth = 1e-6;
  const bool has_breadth = high - low > least_breadth * outline.size();
  VerticalAreas result;
  for (const Slab& slab : cut_into_slabs(outline, axes, {ta, tb})) {
    const bool above = has_breadth && slab.from >= low && slab.to <= high;
    ShareCollector stretch(above ? position_on_edge(outline, axes, edge, slab.from) : 0,
                           above ? position_on_edge(outline, axes, edge, slab.to) : outline.length(edge));
    for (const AreaPoint& point : slab.points) {
      const double t = slab.from + point.fraction * (slab.to - slab.from);
      Vec2 lands = outline.middle(edge);
      if (above) {
        lands = outline.at(edge) + position_on_edge(outline, axes, edge, t) * outline.along(edge);
        stretch.add(point.fraction, point.weight);
      } else {
        result.area_beyond += point.weight;
      }
      result.moment_missing += point.weight * (point.point - lands);
    }
    if (above) keep(result.on_edge, stretch);
  }
  return result;
}

}  // namespace topple::structure
