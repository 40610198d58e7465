#include "topple/structure/modelling_checks.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "mesh/usual_mesh.h"
#include "model/index_of.h"
#include "model/modelling_parts.h"
#include "model/odd_parts.h"
#include "model/own_mass.h"
#include "model/panel_area.h"
#include "model/short_number.h"

namespace topple::structure {

namespace {

constexpr double weakest = 1e6, strongest = 1e10, lightest = 10, heaviest = 25e3;  // Pa, kg/m3
constexpr double softest = 1e7, stiffest = 2e12;  // Pa: rubber, diamond; engineers' materials lie between

double tolerance_of(const Building& building) {
  if (!building.units.consistent) return usual_join_tolerance;
  double longest = 0;
  for (const Member& member : building.members) longest = std::max(longest, member.length);
  return 1e-4 * longest;
}

/// Members along a shell's edge are divided at its mesh's nodes, which joins what lies there.
bool along_a_shell(const Building& building, const Member& member) {
  return std::any_of(building.panels.begin(), building.panels.end(), [&](const Panel& panel) {
    if (panel.model != PanelModel::shell) return false;
    const auto has = [&](NodeId node) {
      return std::find(panel.nodes.begin(), panel.nodes.end(), node) != panel.nodes.end();
    };
    return has(member.nodes[0]) || has(member.nodes[1]);
  });
}

void find_nodes_on_members(const Building& building, double tolerance, std::vector<std::string>& warnings) {
  double mean = 0;
  for (const Member& member : building.members) mean += member.length / static_cast<double>(building.members.size());
  const double size = std::max(mean / 2, 4 * tolerance);
  const NodeGrid grid(building, size);
  const bool shells = std::any_of(building.panels.begin(), building.panels.end(),
                                  [](const Panel& panel) { return panel.model == PanelModel::shell; });
  Several on;
  for (const Member& member : building.members) {
    const Vec3 a = building[member.nodes[0]].position + member.offsets[0],
               along = building[member.nodes[1]].position + member.offsets[1] - a;
    const int steps = 1 + static_cast<int>(member.length / size);
    std::vector<std::size_t> found;
    for (int i = 0; i <= steps; ++i)
      grid.near(a + along * (static_cast<double>(i) / steps), [&](std::size_t n) {
        const Vec3 away = building.nodes[n].position - a;
        const double at = away.dot(along) / along.squaredNorm();
        if (at * member.length < 2 * tolerance || (1 - at) * member.length < 2 * tolerance) return;
        if ((away - at * along).norm() > tolerance) return;
        if (std::find(found.begin(), found.end(), n) == found.end()) found.push_back(n);
      });
    if (!found.empty() && shells && along_a_shell(building, member)) continue;
    for (const std::size_t n : found) on.add("node " + building.nodes[n].name + " lies on member " + member.name);
  }
  on.report(
      warnings,
      "what lies on a member between its ends is not joined to it; divide the member at the node, or say `connect`");
}

void find_near_nodes(const Building& building, double tolerance, std::vector<std::string>& warnings) {
  const NodeGrid grid(building, 2 * tolerance);
  Several close;
  for (std::size_t n = 0; n < building.nodes.size(); ++n)
    grid.near(building.nodes[n].position, [&](std::size_t other) {
      if (other <= n) return;
      const double apart = (building.nodes[other].position - building.nodes[n].position).norm();
      if (apart > tolerance) return;
      close.add("nodes " + building.nodes[n].name + " and " + building.nodes[other].name + " are " +
                short_number(apart / building.units.length, 3) + " apart");
    });
  close.report(warnings, "they are not joined; use one node where one is meant, or say `connect`");
}

/// Members on one line through a node that go the same way from it lie over each other for the shorter's length.
void find_overlapping_members(const Building& building, std::vector<std::string>& warnings) {
  std::vector<std::vector<std::size_t>> at(building.nodes.size());
  for (std::size_t m = 0; m < building.members.size(); ++m)
    for (const NodeId node : building.members[m].nodes) at[index_of(node)].push_back(m);
  constexpr double same_way = 1 - 1e-9;
  Several twice, over;
  const auto away = [&](std::size_t m, std::size_t node) -> Vec3 {
    const Member& member = building.members[m];
    const Vec3 x = member.axes.row(0);
    return index_of(member.nodes[0]) == node ? x : Vec3(-x);
  };
  for (std::size_t n = 0; n < at.size(); ++n)
    for (std::size_t i = 0; i < at[n].size(); ++i)
      for (std::size_t j = i + 1; j < at[n].size(); ++j) {
        const Member &a = building.members[at[n][i]], &b = building.members[at[n][j]];
        if (away(at[n][i], n).dot(away(at[n][j], n)) < same_way) continue;
        if (!a.offsets[0].isZero() || !a.offsets[1].isZero() || !b.offsets[0].isZero() || !b.offsets[1].isZero())
          continue;
        const bool same = (a.nodes[0] == b.nodes[0] && a.nodes[1] == b.nodes[1]) ||
                          (a.nodes[0] == b.nodes[1] && a.nodes[1] == b.nodes[0]);
        if (!same)
          over.add("members " + a.name + " and " + b.name + " overlap");
        else if (static_cast<std::size_t>(std::min(a.nodes[0].index, a.nodes[1].index)) == n)
          twice.add("members " + a.name + " and " + b.name + " join the same nodes");
      }
  twice.report(warnings, "both carry, side by side");
  over.report(warnings, "both carry, and the longer one is not joined where the shorter ends");
}

void find_odd_materials(const Building& building, std::vector<std::string>& warnings) {
  if (building.units.consistent) return;
  Several odd;
  for (const Material& material : building.materials) {
    const double E = material.youngs_modulus;
    if (E >= softest && E <= stiffest) continue;
    odd.add("material " + material.name + " has a Young's modulus of " + short_number(E) + " Pa");
  }
  odd.report(warnings, "materials of buildings lie between 1e9 and 1e12 Pa; look at the model's units");
  const auto outside = [&](double value, double least, double most) {
    return value > 0 && (value < least || value > most);
  };
  Several weak, light;
  for (const Material& material : building.materials) {
    if (const double yield = material.yield_strength.value_or(0); outside(yield, weakest, strongest))
      weak.add("material " + material.name + " yields at " + short_number(yield) + " Pa");
    if (outside(material.density, lightest, heaviest))
      light.add("material " + material.name + " has a density of " + short_number(material.density) + " kg/m3");
  }
  weak.report(warnings, "metals yield between 1e7 and 2e9 Pa; look at the model's units");
  light.report(warnings, "materials of buildings have 10 to 25,000 kg/m3; look at the model's units");
}

/// Sections given in the units of a catalogue make members far deeper than they are long (spandrels of tubes are 1.3
/// times). A large area alone may be meant (a link that is to be stiff), unless all members have one.
void find_thick_members(const Building& building, std::vector<std::string>& warnings) {
  constexpr double deepest = 5;  // of its length
  Several thick;
  std::size_t large = 0;
  for (const Member& member : building.members) {
    const Section& section = building[member.section];
    if (std::sqrt(section.area) > member.length) ++large;
    if (section.depth > deepest * member.length)
      thick.add("member " + member.name + " is over five times as deep as it is long");
  }
  thick.report(warnings, "look at its section and the model's units");
  if (large > 0 && large == building.members.size())
    warnings.emplace_back("all members are thicker than they are long: look at their sections and the model's units");
}

/// A case whose combination was forgotten loads nothing; one that is mass serves that alone.
void find_idle_cases(const Building& building, std::vector<std::string>& warnings) {
  std::vector<bool> used(building.cases.size(), false);
  const auto use = [&](LoadCaseId id) { used[index_of(id)] = true; };
  for (const Combination& combination : building.combinations)
    for (const auto& [id, factor] : combination.factors) use(id);
  for (const auto& [id, factor] : building.masses.loads) use(id);
  Several idle;
  for (std::size_t c = 0; c < used.size(); ++c)
    if (!used[c]) idle.add("load case " + building.cases[c].name);
  idle.report(warnings, "no combination has it, so that it loads nothing");
}

/// Of one case: the largest of its loads, over what a load of its kind has at least in buildings, and their sum, N.
struct LoadSize {
  double over_usual = 0, sum = 0;
  bool level = true;  ///< none of them acts downwards or up
  void add(const Vec6& load, double usual, double spread) {
    add(load.norm(), usual, spread);
    if (load.z() != 0) level = false;
  }
  void add(double value, double usual, double spread) {
    over_usual = std::max(over_usual, value / usual);
    sum += value * spread;
  }
};

LoadSize size_of(const LoadCase& one, const Building& building) {
  constexpr double point = 100, line = 50, area = 20;  // N, N/m, Pa: a lamp, a cable, a sheet of felt
  LoadSize size;
  for (const NodeLoad& load : one.nodes) size.add(load.load, point, 1);
  for (const MemberLoad& load : one.members) {
    const Vec6& larger = load.last.norm() > load.first.norm() ? load.last : load.first;
    if (load.kind == MemberLoad::Kind::point) size.add(larger, point, 1);
    if (load.kind == MemberLoad::Kind::distributed) size.add(larger, line, load.to - load.from);
  }
  for (const PanelLoad& load : one.panels) {
    size.add(std::abs(load.pressure), area, panel_area(building, building[load.panel], true));
    size.level = false;
  }
  return size;
}

/// 20 typed for 20 kN: each load of a case is smaller than any that is counted with, and all of them are next to
/// nothing beside the structure's weight: what is meant is seldom below a twentieth of it, and a slip leaves a
/// thousandth. Level loads may be notional ones, some thousandths of it.
void find_tiny_loads(const Building& building, std::vector<std::string>& warnings) {
  if (building.units.consistent) return;
  constexpr double nothing = 0.02, notional = 1e-3;
  const double weight = own_mass(building) * building.gravity;
  Several tiny;
  for (const LoadCase& one : building.cases) {
    const LoadSize size = size_of(one, building);
    if (!(size.over_usual > 0) || size.over_usual >= 1) continue;
    if (size.sum >= (size.level ? notional : nothing) * weight) continue;
    tiny.add("load case " + one.name + " comes to " + short_number(size.sum) + " N in all" +
             (one.self_weight.isZero(0) ? "" : " but for its self weight") + ", beside a weight of " +
             short_number(weight) + " N");
  }
  tiny.report(warnings, "loads are in N, N/m and Pa; are kilonewtons meant?");
}

/// A file that floats on purpose gives a shift for its modes.
void find_no_supports(const Building& building, std::vector<std::string>& warnings) {
  if (building.supports.empty() && building.edge_supports.empty() && building.requested.frequency_shift <= 0)
    warnings.emplace_back("nothing is supported: no node and no edge of a shell; `supports` hold a structure");
}

std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0]++;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t changed = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, changed});
    }
  }
  return row[b.size()];
}

/// A curved shell drawn by flat panels is a folded plate: with folds of 11 degrees the pinched hemisphere moves 25 %
/// too little on any mesh, with 6 degrees 4 %.
void find_folds(const Building& building, std::vector<std::string>& warnings) {
  constexpr double degree = 3.14159265358979323846 / 180, most = 7 * degree;
  const std::vector<ShellFold> folds = shell_folds(building, most);
  if (folds.empty()) return;
  const auto widest = std::max_element(folds.begin(), folds.end(),
                                       [](const ShellFold& a, const ShellFold& b) { return a.angle < b.angle; });
  char text[64];
  std::snprintf(text, sizeof text, "%.1f degrees", widest->angle / degree);
  warnings.push_back(
      "shells " + building[widest->panel].name + " and " + building[widest->next].name + " meet at a fold of " + text +
      (folds.size() > 1 ? " (and " + std::to_string(folds.size() - 1) + " more edges are folded so)" : "") +
      ": if a curved surface is meant, it is too stiff; draw it by panels that turn by 6 degrees or less");
}

/// What loads bend members by, over all cases.
struct Bending {
  bool vertical = false, sideways = false;
};

std::vector<Bending> bending_of_members(const Building& building) {
  std::vector<Bending> all(building.members.size());
  const auto bend = [&](std::size_t m, const Vec3& force) {
    const Vec3 x = building.members[m].axes.row(0), across = force - x.dot(force) * x;
    constexpr double rounding = 1e-9;
    const double least = rounding * force.norm();
    if (std::abs(across.z()) > least) all[m].vertical = true;
    if (across.head<2>().norm() > least) all[m].sideways = true;
  };
  for (const LoadCase& load_case : building.cases) {
    for (const MemberLoad& load : load_case.members) {
      if (load.kind == MemberLoad::Kind::temperature) continue;
      const auto m = index_of(load.member);
      for (const Vec6& at : {load.first, load.last}) {
        const Vec3 force = at.head<3>();
        bend(m, load.frame == LoadFrame::local ? Vec3(building.members[m].axes.transpose() * force) : force);
      }
    }
    for (std::size_t m = 0; m < all.size(); ++m)
      if (building[building.members[m].material].density > 0) bend(m, load_case.self_weight);
  }
  return all;
}

/// Iy and Iz in each other's place: level members that nothing bends but what acts vertically, and that about the weak
/// axis. Told where nobody can see it from the section's shape: of sections given by numbers, and of members turned on
/// their side.
void find_weak_bending(const Building& building, std::vector<std::string>& warnings) {
  constexpr double level = 0.1, upright = 0.9, weaker = 3;
  const std::vector<Bending> bending = bending_of_members(building);
  Several weak;
  for (std::size_t m = 0; m < building.members.size(); ++m) {
    const Member& member = building.members[m];
    const Section& section = building[member.section];
    const double z_up = std::abs(member.axes(2, 2)), y_up = std::abs(member.axes(1, 2));
    const bool turned = y_up > upright;
    if (member.kind != MemberKind::beam || member.axial != AxialAction::both) continue;
    if (std::abs(member.axes(0, 2)) > level || std::max(z_up, y_up) < upright) continue;
    if (!bending[m].vertical || bending[m].sideways) continue;
    const bool numbers = section.shape == Section::Shape::numbers && section.catalogue.empty();
    if (!numbers && !turned) continue;
    const double I = turned ? section.Iz : section.Iy, other = turned ? section.Iy : section.Iz;
    if (!(weaker * I < other)) continue;
    const std::string by = turned ? "Iz" : "Iy", than = turned ? "Iy" : "Iz";
    weak.add("member " + member.name + " (section " + section.name + ") bends by its " + by + ", 1/" +
             short_number(other / I, 3) + " of " + than);
  }
  weak.report(warnings,
              "level members bend vertically by Iy unless `up` turns them; are Iy and Iz, or the axes, exchanged?");
}

}  // namespace

std::vector<std::string> modelling_warnings(const Building& building) {
  std::vector<std::string> warnings;
  const double tolerance = tolerance_of(building);
  if (!building.members.empty()) {
    find_nodes_on_members(building, tolerance, warnings);
    find_overlapping_members(building, warnings);
  }
  find_near_nodes(building, tolerance, warnings);
  find_no_supports(building, warnings);
  find_odd_materials(building, warnings);
  find_thick_members(building, warnings);
  find_idle_cases(building, warnings);
  find_tiny_loads(building, warnings);
  find_weak_bending(building, warnings);
  find_odd_joints(building, warnings);
  find_folds(building, warnings);
  find_odd_parts(building, tolerance, warnings);
  return warnings;
}

std::string did_you_mean(const std::string& name, const std::vector<std::string>& known) {
  std::size_t least = name.size() / 3 + 1;
  const std::string* nearest = nullptr;
  for (const std::string& other : known)
    if (const std::size_t distance = edit_distance(name, other); distance < least) {
      least = distance;
      nearest = &other;
    }
  return nearest == nullptr ? "" : " (did you mean " + *nearest + "?)";
}

}  // namespace topple::structure
