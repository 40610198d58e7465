#include "design/mode_lengths.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "model/index_of.h"

namespace topple::structure {

namespace {

/// Mean compression along the member.
double compression(const MemberResult& result) { return (result.end_forces(0) - result.end_forces(6)) / 2; }

/// How a member bends in a mode.
struct Bend {
  double slope = 0;     ///< root mean square of the slope against the chord
  bool driven = false;  ///< its compression does enough of the work that bends it
};

/// Of the cubic through a member's ends, for buckling about y (sideways along z) and about z (along y). An end that is
/// released turns as the other one makes it. With `a` and `b` the slopes against the chord c at both ends, the integral
/// of v'^2 is L (c^2 + (2 a^2 - a b + 2 b^2)/15) and that of v''^2 is 4 (a^2 + a b + b^2)/L.
std::array<Bend, 2> bends(const Building& building, MemberId id, const solver::BucklingMode& mode, double force) {
  const Member& m = building[id];
  const Section& section = building[m.section];
  std::array<Vec3, 2> place, turn;
  for (std::size_t end = 0; end < 2; ++end) {
    const Vec6& u = mode.shape[index_of(m.nodes[end])];
    const Vec3 turned = u.tail<3>();
    place[end] = m.axes * (u.head<3>() + turned.cross(m.offsets[end]));
    turn[end] = m.axes * turned;
  }
  std::array<Bend, 2> found{};
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const Eigen::Index sideways = axis == 0 ? 2 : 1, about = axis == 0 ? 1 : 2;
    const double chord = (place[1](sideways) - place[0](sideways)) / m.length, sign = axis == 0 ? -1 : 1;
    double a = sign * turn[0](about) - chord, b = sign * turn[1](about) - chord;
    const auto released = [&](int end) { return building[building.joint(id, end)].stiffness(3 + about) == 0; };
    if (released(0) && released(1)) continue;
    if (released(0)) a = -b / 2;
    if (released(1)) b = -a / 2;
    const double bent = std::max(0.0, (2 * a * a - a * b + 2 * b * b) / 15);
    const double work = mode.factor * force * m.length * (chord * chord + bent);
    const double energy = building[m.material].youngs_modulus * (axis == 0 ? section.Iy : section.Iz) * 4 *
                          (a * a + a * b + b * b) / m.length;
    found[axis] = {std::sqrt(bent), force > 0 && work >= least_driven * energy};
  }
  return found;
}

}  // namespace

std::vector<double> largest_bends(const Building& building, const CombinationResult& combination) {
  std::vector<double> largest(combination.buckling.size(), 0);
  for (std::size_t k = 0; k < largest.size(); ++k)
    for (std::size_t i = 0; i < building.members.size(); ++i)
      for (const Bend& bend :
           bends(building, MemberId(i), combination.buckling[k], compression(combination.members[i])))
        if (bend.driven) largest[k] = std::max(largest[k], bend.slope);
  return largest;
}

std::array<ModeLength, 2> lengths_from_modes(const Building& building, MemberId member,
                                             const CombinationResult& combination,
                                             const std::vector<double>& largest_bends) {
  std::array<ModeLength, 2> found;
  const double force = compression(combination.members[index_of(member)]);
  const Member& m = building[member];
  const Section& section = building[m.section];
  for (ModeLength& one : found)
    if (!combination.buckling.empty()) one.part = force > 0 ? ModePart::hardly_bends : ModePart::not_pressed;
  if (!(force > 0)) return found;
  for (std::size_t k = 0; k < combination.buckling.size(); ++k) {
    const solver::BucklingMode& mode = combination.buckling[k];
    const auto both = bends(building, member, mode, force);
    for (std::size_t axis = 0; axis < 2; ++axis) {
      if (found[axis].part == ModePart::takes_part || !(both[axis].slope > takes_part * largest_bends[k])) continue;
      if (!both[axis].driven) {
        found[axis].part = ModePart::is_bent;
        continue;
      }
      const double inertia = axis == 0 ? section.Iy : section.Iz;
      found[axis] = {ModePart::takes_part, std::numbers::pi * std::sqrt(building[m.material].youngs_modulus * inertia /
                                                                        (mode.factor * force))};
    }
  }
  return found;
}

std::array<std::optional<double>, 2> longest_by_modes(const Building& building, MemberId member,
                                                      const CombinationResult& combination) {
  const double force = compression(combination.members[index_of(member)]);
  if (!(force > 0) || combination.buckling.empty()) return {};
  const Member& m = building[member];
  const auto length = [&](double inertia) {
    return std::numbers::pi *
           std::sqrt(building[m.material].youngs_modulus * inertia / (combination.buckling.front().factor * force));
  };
  return {length(building[m.section].Iy), length(building[m.section].Iz)};
}

}  // namespace topple::structure
