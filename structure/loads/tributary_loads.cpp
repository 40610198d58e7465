// What a membrane or cladding panel hands to the members along its edges.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>

#include "edge_placement.h"
#include "loads/tributary_loads.h"
#include "model/index_of.h"
#include "tributary_areas.h"

namespace topple::structure {

namespace {

constexpr double level = 1e-6;  // of the panel's size: heights that differ less are equal

PanelOutline outline_of(const Building& building, const Panel& panel, const std::vector<std::vector<Vec2>>& holes) {
  PanelOutline outline;
  const Vec3& origin = building[panel.nodes[0]].position;
  for (std::size_t i = 0; i < 4; ++i)
    outline.corner[i] = panel.axes.topRows<2>() * (building[panel.nodes[i]].position - origin);
  outline.openings = panel.openings;
  outline.openings.insert(outline.openings.end(), holes.begin(), holes.end());
  return outline;
}

/// Which of the edges bear the panel: all four, or an opposite pair (0 and 2, or 1 and 3).
struct Bearing {
  bool all = false;
  std::size_t pair = 0;
};

std::optional<Bearing> bearing_of(const std::array<bool, 4>& holds) {
  const bool first = holds[0] && holds[2], second = holds[1] && holds[3];
  if (first && second) return Bearing{true, 0};
  if (first) return Bearing{false, 0};
  if (second) return Bearing{false, 1};
  return std::nullopt;
}

Vec2 shorter_span(const PanelOutline& outline) {
  const Vec2 first = outline.middle(2) - outline.middle(0), second = outline.middle(1) - outline.middle(3);
  return second.norm() < first.norm() ? second : first;
}

/// Both pairs of edges by the lever rule, sharing as they do in the whole panel.
TributaryAreas areas_with_holes(const PanelOutline& outline) {
  PanelOutline whole = outline;
  whole.openings.clear();
  std::array<double, 2> area{};
  const TributaryAreas parts = two_way_areas(whole);
  for (std::size_t edge = 0; edge < 4; ++edge)
    for (const TributaryStrip& part : parts[edge])
      area[edge % 2] += (part.first + part.last) / 2 * (part.to - part.from);
  TributaryAreas shares;
  for (std::size_t pair = 0; pair < 2; ++pair) {
    const double share = area[pair] / (area[0] + area[1]);
    const TributaryAreas strips = strip_areas(outline, outline.middle(pair + 2) - outline.middle(pair));
    for (std::size_t edge = 0; edge < 4; ++edge)
      for (const TributaryStrip& part : strips[edge])
        shares[edge].push_back({part.from, part.to, share * part.first, share * part.last});
  }
  return shares;
}

/// Shares of what acts across the panel.
TributaryAreas areas_across(const PanelOutline& outline, Span span, const Bearing& bearing, bool opened_by_design) {
  if (!bearing.all) return edge_pair_areas(outline, bearing.pair);
  if (span == Span::x) return strip_areas(outline, Vec2::UnitX());
  if (span == Span::y) return strip_areas(outline, Vec2::UnitY());
  if (outline.openings.empty()) return two_way_areas(outline);
  return opened_by_design ? strip_areas(outline, shorter_span(outline)) : areas_with_holes(outline);
}

/// The bearing edge that lies lowest; none when they lie equally high as a pair or all together.
std::optional<std::size_t> lowest_edge(const Building& building, const Panel& panel, const Bearing& bearing,
                                       double size) {
  std::array<double, 4> height{};
  for (std::size_t i = 0; i < 4; ++i)
    height[i] = 0.5 * (building[panel.nodes[i]].position.z() + building[panel.nodes[(i + 1) % 4]].position.z());
  const auto counts = [&](std::size_t edge) { return bearing.all || edge % 2 == bearing.pair; };
  std::size_t lowest = bearing.all ? 0 : bearing.pair;
  for (std::size_t i = 0; i < 4; ++i)
    if (counts(i) && height[i] < height[lowest] - level * size) lowest = i;
  if (height[(lowest + 2) % 4] - height[lowest] <= level * size) return std::nullopt;
  return lowest;
}

class Handing {
 public:
  Handing(const Building& building, const EdgeMembers& edges, PanelId panel, const std::vector<bool>& member_stands)
      : building_(building), edges_(edges), panel_(panel), stands_(member_stands) {
    result.edge_force.fill(Vec3::Zero());
  }

  void hand(const TributaryAreas& shares, const PanelOutline& outline, const Vec3& force) {
    for (std::size_t edge = 0; edge < 4; ++edge) hand(shares[edge], outline, edge, force);
  }

  void hand(const std::vector<TributaryStrip>& shares, const PanelOutline& outline, std::size_t edge,
            const Vec3& force) {
    if (shares.empty()) return;
    const EdgePlacement placement = placement_of(edge);
    // A warped panel's edges are a little longer than their projections.
    const double ratio = placement.length() / outline.length(edge);
    for (const TributaryStrip& share : shares) {
      const EdgeLoad load{share.from * ratio, share.to * ratio, force * (share.first / ratio),
                          force * (share.last / ratio)};
      add(placement, edge, load);
    }
  }

  /// In-plane load goes straight down to the lowest edge. What lies beyond its ends is spread evenly over it, and the
  /// couple about the normal that is then missing comes back as a push and pull along the edge.
  void hand_down(const PanelOutline& outline, std::size_t edge, const Vec3& force) {
    const Mat3& axes = building_[panel_].axes;
    const Vec2 up = axes.topRows<2>() * Vec3::UnitZ();
    const VerticalAreas shares = vertical_areas(outline, edge, up);
    hand(shares.on_edge, outline, edge, force);
    const EdgePlacement placement = placement_of(edge);
    const double length = placement.length(), scale = outline.size() * outline.size();
    constexpr double rounding = 1e-14;
    if (std::abs(shares.area_beyond) > rounding * scale) {
      const Vec3 even = force * (shares.area_beyond / length);
      add(placement, edge, {0, length, even, even});
    }
    const Vec2 in_plane = axes.topRows<2>() * force, &m = shares.moment_missing;
    const double couple = m.x() * in_plane.y() - m.y() * in_plane.x();
    if (std::abs(couple) <= rounding * scale * outline.size() * in_plane.norm()) return;
    const Vec2 along = outline.along(edge);
    const Vec3 across = axes.transpose() * Vec3(-along.y(), along.x(), 0);
    const Vec3 most = across * (6 * couple / (length * length));
    add(placement, edge, {0, length, -most, most});
  }

  TributaryLoads result;

 private:
  [[nodiscard]] EdgePlacement placement_of(std::size_t edge) const {
    return {building_, edges_, panel_, static_cast<int>(edge), stands_};
  }
  void add(const EdgePlacement& placement, std::size_t edge, const EdgeLoad& load) {
    placement.add(load, result);
    result.edge_force[edge] += load.resultant();
  }

  const Building& building_;
  const EdgeMembers& edges_;
  PanelId panel_;
  const std::vector<bool>& stands_;
};

}  // namespace

TributaryLoads tributary_loads(const Building& building, const EdgeMembers& edges, PanelId id,
                               const PanelAction& action, const std::array<bool, 4>& edge_holds,
                               const std::vector<bool>& member_stands) {
  return tributary_loads_of_broken(building, edges, id, action, edge_holds, member_stands, {});
}

TributaryLoads tributary_loads_of_broken(const Building& building, const EdgeMembers& edges, PanelId id,
                                         const PanelAction& action, const std::array<bool, 4>& edge_holds,
                                         const std::vector<bool>& member_stands,
                                         const std::vector<std::vector<Vec2>>& holes) {
  const Panel& panel = building[id];
  Handing handing(building, edges, id, member_stands);
  const std::optional<Bearing> bearing = bearing_of(edge_holds);
  if (panel.model == PanelModel::shell || !bearing) return std::move(handing.result);
  const Vec3 normal = panel.axes.row(2);
  const Vec3 whole = action.body_force - action.pressure * normal;
  if (whole.isZero(0)) return std::move(handing.result);
  const PanelOutline outline = outline_of(building, panel, holes);
  const Vec3 across = whole.dot(normal) * normal;
  Vec3 within = whole - across;
  constexpr double rounding = 1e-14;
  if (within.norm() <= rounding * whole.norm()) within.setZero();
  const auto lowest = lowest_edge(building, panel, *bearing, outline.size());
  const bool down = lowest && !within.isZero(0);
  handing.hand(areas_across(outline, panel.span, *bearing, !panel.openings.empty()), outline, down ? across : whole);
  if (down) handing.hand_down(outline, *lowest, within);
  return std::move(handing.result);
}

}  // namespace topple::structure
