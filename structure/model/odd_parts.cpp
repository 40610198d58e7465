#include "model/odd_parts.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "model/index_of.h"
#include "model/modelling_parts.h"
#include "model/short_number.h"

namespace topple::structure {

namespace {

Vec3 end_of(const Building& building, const Member& member, std::size_t end) {
  return building[member.nodes[end]].position + member.offsets[end];
}

/// Of a rectangle with the same area and the larger of both second moments; catalogues and shapes have their own.
double depth_of(const Section& section) {
  if (section.depth > 0) return section.depth;
  return section.area > 0 ? std::sqrt(12 * std::max(section.Iy, section.Iz) / section.area) : 0;
}

void find_odd_slenderness(const Building& building, std::vector<std::string>& warnings) {
  constexpr double wire = 500, deepest = 5;
  Several slender, thick;
  for (const Member& member : building.members) {
    const Section& section = building[member.section];
    const double depth = depth_of(section);
    const double size = std::max(depth, section.depth > 0 ? 0 : std::sqrt(section.area));  // large areas are links
    if (member.axial == AxialAction::both && size > 0 && member.length > wire * size)
      slender.add("member " + member.name + " is " + short_number(member.length / size, 3) + " times as long as deep");
    if (section.depth == 0 && depth > deepest * member.length)
      thick.add("member " + member.name + " (section " + section.name + ") has the bending stiffness of one " +
                short_number(depth / member.length, 3) + " times as deep as long");
  }
  slender.report(warnings, "look at its nodes and section, and at the units of both");
  thick.report(warnings, "look at its section and the model's units");
}

/// How much hangs on each node: ends of members, corners of panels, supports, diaphragms.
std::vector<int> things_at_nodes(const Building& building, bool with_supports) {
  std::vector<int> count(building.nodes.size(), 0);
  const auto add = [&](NodeId node) { ++count[index_of(node)]; };
  for (const Member& member : building.members)
    for (const NodeId node : member.nodes) add(node);
  for (const Panel& panel : building.panels)
    for (const NodeId node : panel.nodes) add(node);
  for (const Diaphragm& diaphragm : building.diaphragms)
    for (const NodeId node : diaphragm.nodes) add(node);
  if (with_supports)
    for (const NodeSupport& support : building.supports) add(support.node);
  return count;
}

double distance(const Vec3& point, const Vec3& a, const Vec3& b) {
  const Vec3 along = b - a;
  const double at = std::clamp((point - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
  return (point - a - at * along).norm();
}

/// An end on which nothing hangs, nearer to another member than its own member is deep: their bodies touch.
void find_ends_beside_members(const Building& building, double tolerance, std::vector<std::string>& warnings) {
  const std::vector<int> count = things_at_nodes(building, true);
  Several beside;
  for (const Member& member : building.members)
    for (std::size_t end = 0; end < 2; ++end) {
      if (count[index_of(member.nodes[end])] != 1) continue;
      const Vec3 place = end_of(building, member, end);
      const Member* nearest = nullptr;
      double least = std::min(depth_of(building[member.section]), member.length / 4);
      for (const Member& other : building.members) {
        if (&other == &member || other.nodes[0] == member.nodes[1 - end] || other.nodes[1] == member.nodes[1 - end])
          continue;
        const double away = distance(place, end_of(building, other, 0), end_of(building, other, 1));
        if (away <= tolerance || away >= least) continue;
        least = away;
        nearest = &other;
      }
      if (nearest != nullptr)
        beside.add("member " + member.name + " ends at node " + building[member.nodes[end]].name + ", " +
                   short_number(least / building.units.length, 3) + " from member " + nearest->name);
    }
  beside.report(warnings, "nothing joins them; use one node where they meet, or an offset");
}

/// Beams whose axes cross between their ends; braces often do so on purpose.
void find_crossing_beams(const Building& building, double tolerance, std::vector<std::string>& warnings) {
  std::vector<std::size_t> beams;
  double mean = 0;
  for (std::size_t m = 0; m < building.members.size(); ++m)
    if (building.members[m].kind == MemberKind::beam && building.members[m].axial == AxialAction::both) {
      beams.push_back(m);
      mean += building.members[m].length;
    }
  if (beams.size() < 2) return;
  // Beams by the cubes that their axes pass.
  const double size = mean / static_cast<double>(beams.size());
  std::unordered_map<std::uint64_t, std::vector<std::size_t>> cells;
  const auto key = [&](const Vec3& p) {
    std::uint64_t hash = 1469598103934665603ULL;
    for (const int c : {0, 1, 2})
      hash = (hash ^ static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(p[c] / size + 0.25)))) *
             1099511628211ULL;
    return hash;
  };
  Several crossing;
  const auto look = [&](const Member& a, const Member& b) {
    for (const NodeId node : a.nodes)
      if (node == b.nodes[0] || node == b.nodes[1]) return;
    const Vec3 p = end_of(building, a, 0), q = end_of(building, b, 0);
    const Vec3 u = end_of(building, a, 1) - p, v = end_of(building, b, 1) - q, w = p - q;
    const double uu = u.dot(u), uv = u.dot(v), vv = v.dot(v), d = uu * vv - uv * uv;
    constexpr double parallel = 1e-6;
    if (d < parallel * uu * vv) return;
    const double s = (uv * v.dot(w) - vv * u.dot(w)) / d, t = (uu * v.dot(w) - uv * u.dot(w)) / d;
    const double margin_a = 2 * tolerance / std::sqrt(uu), margin_b = 2 * tolerance / std::sqrt(vv);
    if (s < margin_a || s > 1 - margin_a || t < margin_b || t > 1 - margin_b) return;
    if ((w + s * u - t * v).norm() < tolerance) crossing.add("beams " + a.name + " and " + b.name + " cross");
  };
  for (const std::size_t m : beams) {
    const Member& member = building.members[m];
    const Vec3 a = end_of(building, member, 0), along = end_of(building, member, 1) - a;
    const int steps = 1 + static_cast<int>(16 * member.length / size);
    std::vector<std::uint64_t> passed;
    for (int i = 0; i <= steps; ++i) passed.push_back(key(a + along * (static_cast<double>(i) / steps)));
    std::sort(passed.begin(), passed.end());
    passed.erase(std::unique(passed.begin(), passed.end()), passed.end());
    std::vector<std::size_t> met;
    for (const std::uint64_t cell : passed) {
      std::vector<std::size_t>& there = cells[cell];
      met.insert(met.end(), there.begin(), there.end());
      there.push_back(m);
    }
    std::sort(met.begin(), met.end());
    met.erase(std::unique(met.begin(), met.end()), met.end());
    for (const std::size_t other : met) look(building.members[other], member);
  }
  crossing.report(warnings,
                  "nothing joins them; divide both at a node where they meet, or say which is above by height");
}

void find_idle_supports(const Building& building, std::vector<std::string>& warnings) {
  const std::vector<int> count = things_at_nodes(building, false);
  Several idle;
  for (const NodeSupport& support : building.supports)
    if (count[index_of(support.node)] == 0) idle.add("support at node " + building[support.node].name);
  idle.report(warnings, "no member, panel or diaphragm is there, so that it holds nothing");
}

Vec3 middle(const Building& building, const Panel& panel) {
  Vec3 sum = Vec3::Zero();
  for (const NodeId node : panel.nodes) sum += building[node].position / 4;
  return sum;
}

/// True where the middle of `inner` lies in `outer`, in about its plane.
bool covers(const Building& building, const Panel& outer, const Panel& inner, double tolerance) {
  constexpr double same_plane = 0.999;
  if (std::abs(outer.axes.row(2).dot(inner.axes.row(2))) < same_plane) return false;
  const Vec3 point = middle(building, inner), normal = outer.axes.row(2);
  if (std::abs((point - building[outer.nodes[0]].position).dot(normal)) > 10 * tolerance) return false;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3 a = building[outer.nodes[i]].position, b = building[outer.nodes[(i + 1) % 4]].position;
    if ((b - a).cross(point - a).dot(normal) <= tolerance * (b - a).norm()) return false;
  }
  return true;
}

void find_panels_over_panels(const Building& building, double tolerance, std::vector<std::string>& warnings) {
  std::vector<std::pair<double, std::size_t>> by_place;
  double reach = 0;
  for (std::size_t p = 0; p < building.panels.size(); ++p) {
    const Vec3 centre = middle(building, building.panels[p]);
    by_place.emplace_back(centre.x(), p);
    for (const NodeId node : building.panels[p].nodes)
      reach = std::max(reach, (building[node].position - centre).norm());
  }
  std::sort(by_place.begin(), by_place.end());
  Several over;
  for (std::size_t i = 0; i < by_place.size(); ++i)
    for (std::size_t j = i + 1; j < by_place.size() && by_place[j].first - by_place[i].first <= reach; ++j) {
      const Panel &a = building.panels[by_place[i].second], &b = building.panels[by_place[j].second];
      if (a.model == PanelModel::cladding || b.model == PanelModel::cladding) continue;
      if (covers(building, a, b, tolerance) || covers(building, b, a, tolerance))
        over.add("panels " + a.name + " and " + b.name + " lie over each other");
    }
  over.report(warnings, "both carry");
}

void find_odd_panels(const Building& building, std::vector<std::string>& warnings) {
  constexpr double half = 0.5, level = 0.9;
  Several thick, lifted;
  for (const Panel& panel : building.panels) {
    double shortest = unlimited;
    for (std::size_t i = 0; i < 4; ++i)
      shortest =
          std::min(shortest, (building[panel.nodes[(i + 1) % 4]].position - building[panel.nodes[i]].position).norm());
    if (panel.thickness > half * shortest)
      thick.add("panel " + panel.name + " is " + short_number(panel.thickness / building.units.length, 3) + " thick");
  }
  for (const LoadCase& load_case : building.cases)
    for (const PanelLoad& load : load_case.panels)
      if (const Panel& panel = building[load.panel]; load.pressure > 0 && panel.axes(2, 2) < -level)
        lifted.add("load case " + load_case.name + " presses on panel " + panel.name);
  thick.report(warnings, "more than half of its shorter side: look at the model's units");
  lifted.report(warnings,
                "its normal looks down, so that the pressure lifts it: go round its nodes the other way if weight is "
                "meant");
}

void find_lifting_weight(const Building& building, std::vector<std::string>& warnings) {
  Several lifting;
  for (const LoadCase& load_case : building.cases)
    if (load_case.self_weight.z() > 0) lifting.add("load case " + load_case.name);
  lifting.report(warnings, "its self weight acts upwards; accepted as it stands, a positive number acts down");
}

}  // namespace

void find_odd_parts(const Building& building, double tolerance, std::vector<std::string>& warnings) {
  find_odd_slenderness(building, warnings);
  find_ends_beside_members(building, tolerance, warnings);
  find_crossing_beams(building, tolerance, warnings);
  find_idle_supports(building, warnings);
  find_panels_over_panels(building, tolerance, warnings);
  find_odd_panels(building, warnings);
  find_lifting_weight(building, warnings);
}

}  // namespace topple::structure
