#pragma once
// The least force at a contact at which a joint fails. Demands are linear in the force and a joint's utilisation is a
// convex function of its demand, so the force is found directly.
#include <span>
#include <vector>

#include "topple/structure/standing_frame.h"

namespace topple::structure {

struct FirstFailure {
  double force = unlimited;
  std::vector<JointBreak> joints;  ///< all that fail within 1e-6 (relative) of it, in order of id, cause impact
};

/// Least positive F with utilisation(demand + F step) = 1; unlimited when there is none. The utilisation at F = 0 is
/// below 1.
[[nodiscard]] double failing_force(const JointCapacity& capacity, double strength, const Vec6& demand,
                                   const Vec6& step);

/// A joint that fails in an impact, by this use.
[[nodiscard]] JointBreak impact_break(JointId joint, const Utilisation& used);

/// Joints that are over capacity without the force are left to the generations. `limit`: forces above it do not matter.
[[nodiscard]] FirstFailure first_failure(const StandingFrame& frame, const StandingFrame::UnitResponse& response,
                                         std::span<const double> strength_factors, double limit);

}  // namespace topple::structure
