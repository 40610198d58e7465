#include "design/mode_lengths.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace topple::structure {

namespace {

/// Mean compression along the member.
double compression(const MemberResult& result) { return (result.end_forces(0) - result.end_forces(6)) / 2; }

/// Root mean square of the slope against the chord of the cubic through a member's ends: for buckling about y (sideways
/// along z) and about z (along y). An end that is released turns as the other one makes it.
std::array<double, 2> bends(const Building& building, MemberId id, const std::vector<Vec6>& shape) {
  const Member& m = building[id];
  std::array<Vec3, 2> place, turn;
  for (std::size_t end = 0; end < 2; ++end) {
    const Vec6& u = shape[static_cast<std::size_t>(m.nodes[end].index)];
    const Vec3 turned = u.tail<3>();
    place[end] = m.axes * (u.head<3>() + turned.cross(m.offsets[end]));
    turn[end] = m.axes * turned;
  }
  std::array<double, 2> found{};
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const Eigen::Index sideways = axis == 0 ? 2 : 1, about = axis == 0 ? 1 : 2;
    const double chord = (place[1](sideways) - place[0](sideways)) / m.length, sign = axis == 0 ? -1 : 1;
    double a = sign * turn[0](about) - chord, b = sign * turn[1](about) - chord;
    const auto released = [&](int end) { return building[building.joint(id, end)].stiffness(3 + about) == 0; };
    if (released(0) && released(1)) continue;
    if (released(0)) a = -b / 2;
    if (released(1)) b = -a / 2;
    // Mean square of the slope of a cubic whose ends are at rest: (2 a^2 - a b + 2 b^2)/15.
    found[axis] = std::sqrt(std::max(0.0, (2 * a * a - a * b + 2 * b * b) / 15));
  }
  return found;
}

}  // namespace

std::vector<double> largest_bends(const Building& building, const CombinationResult& combination) {
  std::vector<double> largest(combination.buckling.size(), 0);
  for (std::size_t k = 0; k < largest.size(); ++k)
    for (std::size_t i = 0; i < building.members.size(); ++i) {
      if (!(compression(combination.members[i]) > 0)) continue;
      const auto both = bends(building, MemberId(i), combination.buckling[k].shape);
      largest[k] = std::max({largest[k], both[0], both[1]});
    }
  return largest;
}

std::array<std::optional<double>, 2> lengths_from_modes(const Building& building, MemberId member,
                                                        const CombinationResult& combination,
                                                        const std::vector<double>& largest_bends) {
  std::array<std::optional<double>, 2> lengths;
  const double force = compression(combination.members[static_cast<std::size_t>(member.index)]);
  if (!(force > 0)) return lengths;
  const Member& m = building[member];
  const Section& section = building[m.section];
  for (std::size_t k = 0; k < combination.buckling.size(); ++k) {
    const auto both = bends(building, member, combination.buckling[k].shape);
    for (std::size_t axis = 0; axis < 2; ++axis) {
      if (lengths[axis] || !(both[axis] > takes_part * largest_bends[k])) continue;
      const double inertia = axis == 0 ? section.Iy : section.Iz;
      lengths[axis] = std::numbers::pi * std::sqrt(building[m.material].youngs_modulus * inertia /
                                                   (combination.buckling[k].factor * force));
    }
  }
  return lengths;
}

std::array<std::optional<double>, 2> longest_by_modes(const Building& building, MemberId member,
                                                      const CombinationResult& combination) {
  const double force = compression(combination.members[static_cast<std::size_t>(member.index)]);
  if (!(force > 0) || combination.buckling.empty()) return {};
  const Member& m = building[member];
  const auto length = [&](double inertia) {
    return std::numbers::pi *
           std::sqrt(building[m.material].youngs_modulus * inertia / (combination.buckling.front().factor * force));
  };
  return {length(building[m.section].Iy), length(building[m.section].Iz)};
}

}  // namespace topple::structure
