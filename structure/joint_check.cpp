#include "topple/structure/joint_check.h"

#include <algorithm>
#include <cmath>

namespace topple::structure {

Vec6 member_joint_demand(const solver::Vec12& end_forces, int end) {
  // What the part beyond does to the part before: at the first end that is the reaction to the hub's force.
  return end == 0 ? Vec6(-end_forces.head<6>()) : Vec6(end_forces.tail<6>());
}

Utilisation utilisation(const JointCapacity& capacity, const Vec6& demand, double strength) {
  const std::array<double, 7> demands{std::max(demand[0], 0.0), std::max(-demand[0], 0.0), std::abs(demand[1]),
                                      std::abs(demand[2]),      std::abs(demand[3]),       std::abs(demand[4]),
                                      std::abs(demand[5])};
  std::array<double, 7> ratio{};
  Utilisation used;
  used.capacity = unlimited;
  for (std::size_t i = 0; i < 7; ++i) {
    const double bound = capacity.value[i] * strength;
    if (demands[i] == 0) continue;  // also where strength has fallen to nothing
    ratio[i] = demands[i] / bound;  // 0 where the capacity is unlimited
    if (ratio[i] > used.value) used = {ratio[i], static_cast<Sense>(i), demands[i], bound};
  }
  if (capacity.interaction == Interaction::max) return used;
  // Normal force and both moments together; shear and torsion each alone.
  constexpr auto of = [](Sense sense) { return static_cast<std::size_t>(sense); };
  const double sum = ratio[of(Sense::tension)] + ratio[of(Sense::compression)] + ratio[of(Sense::moment_y)] +
                     ratio[of(Sense::moment_z)];
  if (sum <= used.value) return used;
  Sense largest = Sense::tension;
  for (const Sense sense : {Sense::compression, Sense::moment_y, Sense::moment_z})
    if (ratio[of(sense)] > ratio[of(largest)]) largest = sense;
  return {sum, largest, demands[of(largest)], capacity.value[of(largest)] * strength};
}

}  // namespace topple::structure
