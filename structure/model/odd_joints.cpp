// Strong and weak axes that do not go together: of a joint and its section, of two members in one line.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "model/index_of.h"
#include "model/modelling_parts.h"
#include "model/odd_parts.h"
#include "model/short_number.h"

namespace topple::structure {

namespace {

/// A section has a strong and a weak axis from here on; squarer ones may go either way.
constexpr double much_stiffer = 3;

/// 1: y is the section's strong axis by far, -1: z is, 0: neither.
int strong_axis(const Section& section) {
  if (section.Iy > much_stiffer * section.Iz) return 1;
  return section.Iz > much_stiffer * section.Iy ? -1 : 0;
}

/// Of a pair of a joint's values about y and z: by how much the one about the section's weak axis is the larger one;
/// 0 where it is not, or where either is a release or without limit.
double exchanged(double about_y, double about_z, int strong) {
  if (strong < 0) std::swap(about_y, about_z);
  if (!(about_y > 0) || !std::isfinite(about_z)) return 0;
  return about_z / about_y;
}

/// A joint that bears or holds more about its section's weak axis than about the strong one.
void find_exchanged_joints(const Building& building, std::vector<std::string>& warnings) {
  constexpr double clearly = 1.5;  // splices and end plates may bear alike about both
  Several capacities, springs;
  for (std::size_t m = 0; m < building.members.size(); ++m) {
    const Section& section = building[building.members[m].section];
    const int strong = strong_axis(section);
    if (strong == 0) continue;
    const std::string stronger = strong > 0 ? "y" : "z", weaker = strong > 0 ? "z" : "y";
    for (int end = 0; end < 2; ++end) {
      const Joint& joint = building[building.joint(MemberId(m), end)];
      const std::string told = "joint " + joint.name + " has ";
      const std::string of = " (section " + section.name + ", stronger about " + stronger + ")";
      const auto& capacity = joint.capacity.value;
      const double bears = exchanged(capacity[static_cast<std::size_t>(Sense::moment_y)],
                                     capacity[static_cast<std::size_t>(Sense::moment_z)], strong);
      if (bears > clearly)
        capacities.add(told + "a moment_" + weaker + " of " + short_number(bears, 3) + " times its moment_" + stronger +
                       of);
      const double holds = exchanged(joint.stiffness(4), joint.stiffness(5), strong);
      if (holds > clearly)
        springs.add(told + "a stiffness r" + weaker + " of " + short_number(holds, 3) + " times its r" + stronger + of);
    }
  }
  const char* const meaning = "moments about y bend the member in its x-z plane; are they, or the axes, exchanged?";
  capacities.report(warnings, meaning);
  springs.report(warnings, meaning);
}

/// The member goes on in the other's line beyond the node that they share.
bool in_line(const Member& a, const Member& b, NodeId node) {
  constexpr double one_degree = 0.99985;
  const double same_way = (a.nodes[1] == node) == (b.nodes[0] == node) ? 1 : -1;
  return same_way * a.axes.row(0).dot(b.axes.row(0)) > one_degree;
}

/// Members of one line and section, one of which lies on its side: `up` of the one, or a post that is out of plumb by
/// so little that nobody sees that its `up` is another one.
void find_turned_pieces(const Building& building, std::vector<std::string>& warnings) {
  constexpr double aligned = 0.866;  // 30 degrees
  std::vector<std::vector<std::size_t>> at_node(building.nodes.size());
  for (std::size_t m = 0; m < building.members.size(); ++m) {
    if (strong_axis(building[building.members[m].section]) == 0) continue;
    for (const NodeId node : building.members[m].nodes) at_node[index_of(node)].push_back(m);
  }
  Several turned;
  for (std::size_t n = 0; n < at_node.size(); ++n)
    for (std::size_t i = 0; i < at_node[n].size(); ++i)
      for (std::size_t j = i + 1; j < at_node[n].size(); ++j) {
        const Member &a = building.members[at_node[n][i]], &b = building.members[at_node[n][j]];
        if (a.section != b.section || a.kind != b.kind || !in_line(a, b, NodeId(n))) continue;
        const double along = std::abs(a.axes.row(2).dot(b.axes.row(2)));
        if (along > aligned) continue;
        const double degrees = std::acos(along) * 180 / std::numbers::pi;
        turned.add("members " + a.name + " and " + b.name + " go on in one line, turned by " +
                   short_number(degrees, 3) + " degrees about it");
      }
  turned.report(
      warnings,
      "the strong axis of the one meets the weak axis of the other; `up` or `roll` turns them (a post that is "
      "not quite vertical has another `up` than one that is)");
}

}  // namespace

void find_odd_joints(const Building& building, std::vector<std::string>& warnings) {
  find_exchanged_joints(building, warnings);
  find_turned_pieces(building, warnings);
}

}  // namespace topple::structure
