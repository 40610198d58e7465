// Substeps that are too long for what goes on, as after an impact or a break: taken in parts.
#include <algorithm>
#include <cmath>
#include <limits>

#include "dynamics/dynamic_state.h"

namespace topple::solver {
namespace {

/// Of a beam's length, and in rad: ends that are off by less strain it by a thousandth of what cracks concrete (1e-4),
/// and the joints' uses of that are not asked for.
constexpr double strains_nothing = 1e-7;

bool strains(const Beam& beam, const std::vector<Vec6>& off) {
  return std::any_of(beam.node.begin(), beam.node.end(), [&](int node) {
    const Vec6& own = off[static_cast<std::size_t>(node)];
    return std::max(own.head<3>().cwiseAbs().maxCoeff() / beam.length, own.tail<3>().cwiseAbs().maxCoeff()) >
           strains_nothing;
  });
}

}  // namespace

void FrameDynamics::State::advance_as_needed(const JointLaw& law) {
  advance_substep(&law);
  const int needed = parts_for(substep_error(law));
  if (needed == 1) {
    accept();
    return;
  }
  ++counters.divided;
  put_off();
  divide_substep(needed);
  for (int left = parts; left > 0; --left) {
    if (left < parts) begin_part(left);
    advance_substep(&law);
    break_all(&law);
  }
}

double FrameDynamics::State::substep_error(const JointLaw& law) {
  if (any_crosses(law)) return std::numeric_limits<double>::infinity();
  std::vector<Vec6> off(frame.model().nodes.size(), Vec6::Zero());
  system().node_displacements_of_scaled(method.h * method.h * std::abs(method.beta - 1.0 / 6) * (now.a - before.a),
                                        off);
  double largest = 0;
  for (int beam = 0; beam < static_cast<int>(system().model.beams.size()); ++beam) {
    const auto i = static_cast<std::size_t>(beam);
    if (system().beam_stands[i] == 0 || !strains(system().model.beams[i], off)) continue;
    largest = std::max(largest, law.beam_utilisation(beam, core().end_forces(i, off, Vec12::Zero())));
  }
  return largest;
}

int FrameDynamics::State::parts_for(double error) const {
  int needed = 1;
  while (needed < options.most_parts && !(error <= options.largest_error * std::pow(needed, 3))) needed *= 2;
  return std::min(needed, options.most_parts);
}

void FrameDynamics::State::put_off() {
  kinks.restore();
  now = before;
  nodes.forget();
  accepted = true;
}

void FrameDynamics::State::divide_substep(int into) {
  if (into == parts) return;
  parts = into;
  method = method_of_parts(parts);
  kinks.find_anew(system());
}

GeneralizedAlpha FrameDynamics::State::method_of_parts(int into) const {
  return {whole.h / into, options.spectral_radius, options.damping.stiffness};
}

void FrameDynamics::State::begin_part(int left) {
  changed.begin_part(system(), core().changes, method.h, left);
  substep_load.setZero();
  kinks.begin_substep();
}

}  // namespace topple::solver
