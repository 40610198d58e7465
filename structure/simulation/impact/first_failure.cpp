#include "simulation/impact/first_failure.h"
#include "model/index_of.h"
#include "simulation/impact/impact_settings.h"

#include <algorithm>
#include <cmath>

namespace topple::structure {

double failing_force(const JointCapacity& capacity, double strength, const Vec6& demand, const Vec6& step) {
  const auto used = [&](double force) { return utilisation(capacity, demand + force * step, strength).value; };
  const double slope = utilisation(capacity, step, strength).value;  // reached far out; nowhere exceeded
  if (!(slope > 0)) return unlimited;
  double low = (1 - used(0)) / slope, high = (1 + utilisation(capacity, -demand, strength).value) / slope;
  double used_low = used(low), used_high = used(high);
  if (used_low >= 1) return low;
  // The chord of a convex function lies above it, so its root never passes the failure; halving keeps the other side in
  // step.
  for (int i = 0; i < 200 && high - low > 1e-15 * high; ++i) {
    const double chord = low + (1 - used_low) * (high - low) / (used_high - used_low);
    const double middle = i % 2 == 0 ? std::clamp(chord, low, high) : (low + high) / 2;
    const double at_middle = used(middle);
    if (std::abs(at_middle - 1) <= 4e-16) return middle;
    (at_middle < 1 ? low : high) = middle;
    (at_middle < 1 ? used_low : used_high) = at_middle;
  }
  return high;
}

JointBreak impact_break(JointId joint, const Utilisation& used) {
  JointBreak broken;
  broken.joint = joint;
  broken.cause = BreakCause::impact;
  broken.sense = used.sense;
  broken.demand = used.demand;
  broken.capacity = used.capacity;
  return broken;
}

FirstFailure first_failure(const StandingFrame& frame, const StandingFrame::UnitResponse& response,
                           std::span<const double> strength_factors, double limit) {
  struct Failing {
    JointId joint;
    double force;
    Vec6 demand;
  };
  const Building& building = frame.building();
  std::vector<Failing> failing;
  double least = limit;
  for (const auto& [id, step] : response.demands) {
    const JointCapacity& capacity = building[id].capacity;
    if (!capacity.breakable || !frame.intact(id)) continue;
    const double strength = strength_factors[index_of(id)];
    const Vec6 demand = frame.demand(id);
    const double now = utilisation(capacity, demand, strength).value;
    const double slope = utilisation(capacity, step, strength).value;
    if (now >= 1 || !(slope * least * (1 + impact_settings.same_instant) >= 1 - now)) continue;
    const double force = failing_force(capacity, strength, demand, step);
    if (force > least * (1 + impact_settings.same_instant)) continue;
    failing.push_back({id, force, demand + force * step});
    least = std::min(least, force);
  }
  FirstFailure first;
  for (const Failing& one : failing) {
    if (one.force > least * (1 + impact_settings.same_instant)) continue;
    const double strength = strength_factors[index_of(one.joint)];
    const Utilisation used = utilisation(building[one.joint].capacity, one.demand, strength);
    first.joints.push_back(impact_break(one.joint, used));
  }
  std::sort(first.joints.begin(), first.joints.end(),
            [](const JointBreak& a, const JointBreak& b) { return a.joint < b.joint; });
  if (!first.joints.empty()) first.force = least;
  return first;
}

}  // namespace topple::structure
