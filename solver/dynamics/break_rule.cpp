// Which joints break within a substep, and when.
#include <algorithm>

#include "dynamics/dynamic_state.h"
#include "elements/beam.h"

namespace topple::solver {
namespace {

/// Of a substep: at how many places a use is looked at, and how far the one at which it reaches 1 is narrowed down.
constexpr int looks = 8;
constexpr int halvings = 30;

/// The share of the substep at which the joint first reaches its capacity, by the cubic course of its force; its end
/// where that alone is beyond.
double reached_at(const JointLaw& law, int beam, int end, const SubstepCourse<Vec12>& course) {
  const auto over = [&](double share) { return law.end_utilisation(beam, end, course.at(share)) > 1; };
  if (over(0)) return 0;
  double low = 0, high = 1;
  for (int k = 1; k <= looks; ++k) {
    const double share = static_cast<double>(k) / looks;
    if (over(share)) {
      high = share;
      break;
    }
    low = share;
  }
  if (low >= high) return 1;
  for (int k = 0; k < halvings; ++k) {
    const double middle = (low + high) / 2;
    (over(middle) ? high : low) = middle;
  }
  return high;
}

}  // namespace

Vec12 FrameDynamics::State::fixed_end_of_loads(std::size_t beam, bool at_end) const {
  Vec12 fixed = core().load.fixed_end(beam);
  patterns.add_fixed_end(static_cast<int>(beam), at_end, fixed);
  return fixed;
}

Vec12 FrameDynamics::State::fixed_end_forces(int beam, bool at_end) const {
  Vec12 fixed =
      recent_loads.felt(beam, core().load.fixed_end(static_cast<std::size_t>(beam)), method.h, at_end, accepted);
  patterns.add_fixed_end(beam, at_end, fixed);
  kinks.add_fixed_end(static_cast<std::size_t>(beam), at_end, fixed);
  return fixed;
}

Vec12 FrameDynamics::State::elastic_end_forces(int beam, const std::vector<Vec6>& displacements, bool at_end) const {
  return core().end_forces(static_cast<std::size_t>(beam), displacements, fixed_end_forces(beam, at_end));
}

/// Of the beam in the place that it has, with second order.
Vec12 FrameDynamics::State::end_forces(int beam, bool at_end) const {
  const std::vector<Vec6>& displacements = (at_end ? nodes.end() : nodes.start()).u;
  Vec12 forces = elastic_end_forces(beam, displacements, at_end);
  if (options.second_order && system().beam_stands[static_cast<std::size_t>(beam)] != 0)
    forces += geometric_end_forces(beam, displacements, forces);
  return forces;
}

Vec12 FrameDynamics::State::end_force_rates(int beam, bool at_end) const {
  const NodeMotion& motion = at_end ? nodes.end() : nodes.start();
  const auto i = static_cast<std::size_t>(beam);
  // Loads that go with time change linearly within a substep.
  Vec12 fixed_end_rate = Vec12::Zero();
  if (system().beam_stands[i] != 0)
    fixed_end_rate = (fixed_end_forces(beam, true) - fixed_end_forces(beam, false)) / method.h;
  Vec12 rates = core().end_forces(i, motion.v, fixed_end_rate);
  if (!options.second_order || system().beam_stands[i] == 0) return rates;
  // d/dt Kg(N) u = Kg(N) v + Kg(dN/dt) u
  rates += geometric_end_forces(beam, motion.v, elastic_end_forces(beam, motion.u, at_end)) +
           geometric_end_forces(beam, motion.u, rates);
  return rates;
}

SubstepCourse<Vec12> FrameDynamics::State::course(int beam) const {
  SubstepCourse<Vec12> course;
  course.start = end_forces(beam, false);
  course.end = end_forces(beam, true);
  course.length = method.h;
  course.start_rate = end_force_rates(beam, false);
  course.end_rate = end_force_rates(beam, true);
  return course;
}

void FrameDynamics::State::record_break(const JointBreak& found, double share, const SubstepCourse<Vec12>& course) {
  const auto end = static_cast<std::size_t>(found.end);
  Vec12 mean = course.mean_until(share);
  // What the other end's joint handed over before it broke went through this one.
  mean += changed.fixed_end(found.beam);
  changed.break_joint(found.beam, end, mean.segment<6>(static_cast<Eigen::Index>(6 * end)));
  breaks.push_back(found);
  ++counters.breaks;
  frame.set_end_stiffness(found.beam, found.end, Vec6::Zero());
  // A beam that hangs on a pin alone is no part of the frame: it leaves.
  const RecentLoads::Held left = held(found.beam);
  if (CondensedBeam(left.beam, left.factor).loose()) frame.set_end_stiffness(found.beam, 1 - found.end, Vec6::Zero());
  recent_loads.hold_otherwise(found.beam, held(found.beam));
}

/// By the end stiffness that it has from now on.
RecentLoads::Held FrameDynamics::State::held(int beam) const {
  const auto i = static_cast<std::size_t>(beam);
  RecentLoads::Held held{system().model.beams[i], system().beam_factor[i]};
  held.beam.end_stiffness = core().changes.beam(i).end_stiffness;
  return held;
}

bool FrameDynamics::State::any_crosses(const JointLaw& law) {
  evaluate_end();
  for (int beam = 0; beam < static_cast<int>(system().model.beams.size()); ++beam)
    if (system().beam_stands[static_cast<std::size_t>(beam)] != 0 &&
        law.beam_utilisation(beam, end_forces(beam, true)) > 1)
      return true;
  const std::span<const PlasticHinge> hinges = law.plastic_hinges();
  return std::any_of(hinges.begin(), hinges.end(), [&](const PlasticHinge& hinge) { return turned_out_at(hinge); });
}

bool FrameDynamics::State::break_joints(const JointLaw& law) {
  evaluate_end();
  struct Crossing {
    JointBreak joint;
    double share;
    SubstepCourse<Vec12> course;
  };
  std::vector<Crossing> crossings;
  for (int beam = 0; beam < static_cast<int>(system().model.beams.size()); ++beam) {
    const auto i = static_cast<std::size_t>(beam);
    if (system().beam_stands[i] == 0) continue;
    const Vec12 forces = end_forces(beam, true);
    if (!(law.beam_utilisation(beam, forces) > 1)) continue;
    evaluate_nodes();
    const SubstepCourse<Vec12> own = course(beam);
    for (int end = 0; end < 2; ++end) {
      if (system().model.beams[i].end_stiffness[static_cast<std::size_t>(end)].isZero(0)) continue;
      if (!(law.end_utilisation(beam, end, forces) > 1)) continue;
      const double share = reached_at(law, beam, end, own);
      crossings.push_back({{beam, end, time + share * method.h, own.at(share)}, share, own});
    }
  }
  for (const PlasticHinge& hinge : law.plastic_hinges()) {
    const std::optional<double> share = turned_out_at(hinge);
    if (!share) continue;
    const SubstepCourse<Vec12> own = course(hinge.beam);
    crossings.push_back({{hinge.beam, hinge.end, time + *share * method.h, own.at(*share)}, *share, own});
  }
  if (crossings.empty()) return false;
  std::stable_sort(crossings.begin(), crossings.end(),
                   [](const Crossing& a, const Crossing& b) { return a.share < b.share; });
  const double together =
      crossings.front().share + options.wave_times[static_cast<std::size_t>(crossings.front().joint.beam)] / method.h;
  // In this substep, for another reason.
  const auto is_broken = [&](const JointBreak& joint) {
    return std::any_of(breaks.begin(), breaks.end(),
                       [&](const JointBreak& one) { return one.beam == joint.beam && one.end == joint.end; });
  };
  for (const Crossing& crossing : crossings)
    if (crossing.share <= together && !is_broken(crossing.joint))
      record_break(crossing.joint, crossing.share, crossing.course);
  return true;
}

}  // namespace topple::solver
