#include "standing/motion/component_damping.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "topple/solver/modes.h"

namespace topple::structure {
namespace {

/// Strain energy of a member's axial force and bending between its end forces, linear between them: what it counts by.
double strain_energy(const solver::Beam& beam, const solver::Vec12& f) {
  const double E = beam.youngs_modulus, L = beam.length;
  const auto bending = [&](Eigen::Index axis, double I) {
    const double a = f(axis), b = -f(6 + axis);
    return (a * a + a * b + b * b) * L / (6 * E * I);
  };
  return f(0) * f(0) * L / (2 * E * beam.area) + bending(4, beam.Iy) + bending(5, beam.Iz);
}

bool moves_whole(const solver::VibrationMode& mode, double share) {
  return std::any_of(mode.mass_share.begin(), mode.mass_share.end(), [&](double own) { return own > share; });
}

}  // namespace

std::size_t ComponentDamping::holding(int c) const {
  std::size_t count = 0;
  for (const JointId joint : from_.components.joints[static_cast<std::size_t>(c)])
    if (from_.parts.standing(joint)) ++count;
  return count;
}

double ComponentDamping::share(int c) const {
  double metal = 0, other = 0;
  for (const MemberId member : from_.statics.members(c)) {
    if (!from_.parts.stands(member)) continue;
    const double energy = strain_energy(from_.statics.beam(member), from_.statics.end_forces(member));
    const bool is_metal = from_.building[from_.building[member].material].youngs_modulus >= settings_.metal_modulus;
    (is_metal ? metal : other) += energy;
  }
  if (!(metal + other > 0)) return settings_.metal_damping;
  return (settings_.metal_damping * metal + settings_.other_damping * other) / (metal + other);
}

ComponentDamping::Known ComponentDamping::find(int c, const solver::FrameModel& frame, const solver::MassModel& masses,
                                               const std::vector<Vec6>& rest) const {
  solver::DynamicOptions still;
  still.analysis.threads = from_.threads;
  still.keep_energy = false;
  Known found;
  found.holding = holding(c);
  std::vector<solver::VibrationMode> modes = solver::natural_modes(frame, masses, 1, still.analysis).modes;
  if (modes.empty()) return found;  // supports hold every node
  found.first_frequency = modes.front().angular_frequency;
  const auto of_whole = [&](const solver::VibrationMode& mode) { return moves_whole(mode, settings_.mode_of_whole); };
  if (!of_whole(modes.front()))
    modes = solver::natural_modes(frame, masses, settings_.modes_sought, still.analysis).modes;
  const auto lowest = std::find_if(modes.begin(), modes.end() - 1, of_whole);
  const double quotient = solver::FrameDynamics(frame, masses, still).rayleigh_quotient(rest);
  const double shape = quotient > 0 ? std::sqrt(quotient) : lowest->angular_frequency;
  found.damping = solver::rayleigh_damping(share(c), lowest->angular_frequency, shape);
  return found;
}

const solver::RayleighDamping& ComponentDamping::start(int c, const solver::FrameModel& frame,
                                                       const solver::MassModel& masses, const std::vector<Vec6>& rest) {
  Known& own = known_[c];
  if (own.holding == 0 || own.holding != holding(c)) own = find(c, frame, masses, rest);
  own.looked = 0;
  return own.damping;
}

const solver::RayleighDamping* ComponentDamping::update(int c) {
  Known& known = known_.at(c);
  const std::size_t now = holding(c);
  if (std::exchange(known.looked, now) != now || known.holding == now) return nullptr;
  known = find(c, model_.frame(c), model_.node_masses(c), model_.at_rest(c));
  known.looked = now;
  return &known.damping;
}

}  // namespace topple::structure
