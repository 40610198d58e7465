#include "topple/structure/joint_check.h"

#include <cmath>

namespace topple::structure {

namespace {

struct Ratio {
  double value = 0, demand = 0, capacity = unlimited;
};

Ratio ratio(double demand, double capacity) {
  if (demand == 0) return {0, 0, capacity};
  return {demand / capacity, demand, capacity};
}

std::array<Ratio, 7> ratios(const JointCapacity& capacity, const Vec6& demand, double strength) {
  std::array<double, 7> d{std::max(0.0, demand(0)), std::max(0.0, -demand(0)), std::abs(demand(1)), std::abs(demand(2)),
                          std::abs(demand(3)),      std::abs(demand(4)),       std::abs(demand(5))};
  std::array<Ratio, 7> result;
  for (std::size_t i = 0; i < 7; ++i)
    result[i] = ratio(d[i], capacity.value[i] == unlimited ? unlimited : strength * capacity.value[i]);
  return result;
}

constexpr bool is_normal_stress(Sense sense) {
  return sense != Sense::shear_y && sense != Sense::shear_z && sense != Sense::torsion;
}

}  // namespace

Vec6 member_joint_demand(const solver::Vec12& end_forces, int end) {
  if (end == 1) return end_forces.tail<6>();
  Vec6 demand = end_forces.head<6>();
  demand(0) = -demand(0);
  return demand;
}

Utilisation utilisation(const JointCapacity& capacity, const Vec6& demand, double strength) {
  Utilisation worst;
  if (!capacity.breakable) return worst;
  // What is no number is more than anything bears: std::max would pass over it.
  if (!demand.allFinite() || !std::isfinite(strength)) return {unlimited, Sense::tension, demand.lpNorm<1>(), 0};
  const auto all = ratios(capacity, demand, strength);
  // Of several equal ones the first in the order of the senses.
  std::size_t governing = 0;
  for (std::size_t i = 1; i < 7; ++i)
    if (all[i].value > all[governing].value) governing = i;
  double value = all[governing].value;
  if (capacity.interaction == Interaction::sum) {
    double sum = 0;
    std::size_t largest = 0;
    for (std::size_t i = 0; i < 7; ++i) {
      if (!is_normal_stress(static_cast<Sense>(i))) continue;
      sum += all[i].value;
      if (all[i].value > all[largest].value) largest = i;
    }
    if (sum >= value) {
      value = sum;
      governing = largest;
    }
  }
  return {value, static_cast<Sense>(governing), all[governing].demand, all[governing].capacity};
}

}  // namespace topple::structure
