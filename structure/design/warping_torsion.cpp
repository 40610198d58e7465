#include "design/warping_torsion.h"

#include <algorithm>
#include <cmath>

namespace topple::structure {

namespace {

/// Between two places: chi' at its ends is `slope` + k (-+ coth d0 +- csch d1), d = chi - T/(G J).
struct Interval {
  double length = 0, near = 0, far = 0;  ///< coth(k h) k, csch(k h) k
  double chi0 = 0, chi1 = 0, slope = 0;  ///< of the particular solution T/(G J)
};

Interval interval(double k, double rigidity, double length, double torque0, double torque1) {
  const double kh = k * length;
  Interval i;
  i.length = length;
  i.near = k / std::tanh(kh);
  i.far = kh > 700 ? 0 : k / std::sinh(kh);
  i.chi0 = torque0 / rigidity;
  i.chi1 = torque1 / rigidity;
  i.slope = (i.chi1 - i.chi0) / length;
  return i;
}

/// Solves the tridiagonal system in place (Thomas); it is diagonally dominant.
std::vector<double> solve_tridiagonal(const std::vector<double>& below, std::vector<double> diagonal,
                                      const std::vector<double>& above, std::vector<double> right) {
  const std::size_t n = diagonal.size();
  for (std::size_t i = 1; i < n; ++i) {
    const double factor = below[i] / diagonal[i - 1];
    diagonal[i] -= factor * above[i - 1];
    right[i] -= factor * right[i - 1];
  }
  for (std::size_t i = n; i-- > 0;) {
    if (i + 1 < n) right[i] -= above[i] * right[i + 1];
    right[i] /= diagonal[i];
  }
  return right;
}

/// Twist per length at distinct places: chi' is continuous from interval to interval.
std::vector<double> twists(const std::vector<Interval>& intervals, std::array<bool, 2> held) {
  const std::size_t n = intervals.size() + 1;
  std::vector<double> below(n, 0), diagonal(n, 0), above(n, 0), right(n, 0);
  for (std::size_t e = 0; e < intervals.size(); ++e) {
    const Interval& i = intervals[e];
    // + chi' at the interval's second end, - chi' at its first, are added up to zero at every place.
    diagonal[e] += i.near;
    above[e] -= i.far;
    right[e] += i.near * i.chi0 - i.far * i.chi1 + i.slope;
    diagonal[e + 1] += i.near;
    below[e + 1] -= i.far;
    right[e + 1] += i.near * i.chi1 - i.far * i.chi0 - i.slope;
  }
  for (const std::size_t end : {std::size_t{0}, n - 1}) {
    if (!held[end == 0 ? 0 : 1]) continue;
    diagonal[end] = 1;
    below[end] = above[end] = right[end] = 0;
  }
  return solve_tridiagonal(below, diagonal, above, right);
}

}  // namespace

std::vector<WarpingForces> warping_forces(const SteelSection& steel, std::span<const double> at,
                                          std::span<const SectionForces> stations, std::array<bool, 2> held) {
  const double rigidity = steel.G * steel.J, warping = steel.E * steel.warping;
  const double k = std::sqrt(rigidity / warping);
  const double span = at.back() - at.front();
  const double same_place = 1e-9 * span;
  std::vector<Interval> intervals;
  std::vector<std::size_t> place(stations.size(), 0);
  std::size_t last = 0;
  for (std::size_t s = 1; s < stations.size(); ++s) {
    const double length = at[s] - at[s - 1];
    if (length > same_place) intervals.push_back(interval(k, rigidity, length, stations[s - 1][3], stations[s][3]));
    last = place[s] = intervals.size();
  }
  std::vector<WarpingForces> forces(stations.size());
  if (last == 0) return forces;
  const std::vector<double> chi = twists(intervals, held);
  for (std::size_t s = 0; s < stations.size(); ++s) {
    const std::size_t p = place[s];
    const bool before = p > 0;
    const Interval& i = intervals[before ? p - 1 : 0];
    const double d0 = chi[before ? p - 1 : 0] - i.chi0, d1 = chi[before ? p : 1] - i.chi1;
    const double slope = i.slope + (before ? i.near * d1 - i.far * d0 : i.far * d1 - i.near * d0);
    forces[s] = {-warping * slope, rigidity * chi[p], stations[s][3] - rigidity * chi[p]};
  }
  return forces;
}

std::vector<WarpingForces> worst_warping_forces(const SteelSection& steel, const DesignMember& member,
                                                std::span<const SectionForces> stations) {
  std::vector<WarpingForces> worst(stations.size());
  const auto raise = [](double& value, double found) { value = std::max(value, std::abs(found)); };
  for (const bool first : {false, true})
    for (const bool second : {false, true}) {
      const std::array<bool, 2> held{first, second};
      if (member.warping_held && *member.warping_held != held) continue;
      const std::vector<WarpingForces> found = warping_forces(steel, member.at, stations, held);
      for (std::size_t s = 0; s < found.size(); ++s) {
        raise(worst[s].bimoment, found[s].bimoment);
        raise(worst[s].uniform_torque, found[s].uniform_torque);
        raise(worst[s].warping_torque, found[s].warping_torque);
      }
    }
  return worst;
}

double warping_normal_stress(const SteelSection& steel, double bimoment) {
  return std::abs(bimoment) * (steel.depth - steel.flange) * steel.width / 4 / steel.warping;
}

double warping_shear_stress(const SteelSection& steel, double warping_torque) {
  return 1.5 * std::abs(warping_torque) / ((steel.depth - steel.flange) * steel.width * steel.flange);
}

double elastic_normal_stress(const SteelSection& steel, const SectionForces& at) {
  return std::abs(at[0]) / steel.area + std::abs(at[4]) / steel.elastic_y + std::abs(at[5]) / steel.elastic_z;
}

double uniform_torsion_stress(const SteelSection& steel, double uniform_torque) {
  return std::abs(uniform_torque) * std::max(steel.flange, steel.web) / steel.J;
}

}  // namespace topple::structure
