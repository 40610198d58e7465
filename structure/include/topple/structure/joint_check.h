#pragma once
// How close a joint is to failing.
#include "topple/solver/types.h"
#include "topple/structure/building.h"

namespace topple::structure {

/// What a member's joint carries, local axes: tension positive in x, then shears, torsion, moments as the node
/// gives them to the member at that end. `end_forces` as in solver::StaticSolution; `end` 0 or 1.
[[nodiscard]] Vec6 member_joint_demand(const solver::Vec12& end_forces, int end);

/// How much of its capacity a joint bears.
struct Utilisation {
  double value = 0;              ///< demand over capacity by the joint's rule; 1 breaks it; 0 without a capacity
  Sense sense = Sense::tension;  ///< the sense with the largest ratio
  double demand = 0;             ///< in that sense, N or N m
  double capacity = 0;           ///< in that sense, N or N m
};
/// Ratio of demand to capacity by the joint's interaction rule, with capacities multiplied by `strength`.
[[nodiscard]] Utilisation utilisation(const JointCapacity& capacity, const Vec6& demand, double strength = 1.0);

}  // namespace topple::structure
