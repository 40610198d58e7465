#pragma once
// The push of one impact while ductile joints turn in it: from event to event, each time with the compliance and the
// unloaded places that those which turn then leave.
#include <vector>

#include "simulation/impact/impact.h"
#include "simulation/impact/yielding_joints.h"

namespace topple::structure {

/// Ductile joints of one impact, and how far its push has gone on for them.
struct YieldingPush {
  /// `lost`: J, what impacts before this one lost.
  YieldingPush(const BodyImpact& impact, double lost);
  YieldingJoints joints;
  Eigen::VectorXd laid;  ///< m (and coordinates of modes): by how much the push has its unloaded places further on
  double lost_before = 0;

  /// Until `brittle` joints fail, hinges come to an event, or the push is over; hinges turn as far as they then have.
  [[nodiscard]] Impact::Stop push(Impact& push, const Impact::Utilisation& brittle, double deepest);
  /// A hinge begins to turn, or turns no more, and the push goes on with what gives way then; or the joints returned
  /// have turned too far.
  [[nodiscard]] std::vector<JointBreak> next(Impact& push);
  /// Gives the push the compliance and the unloaded places that the hinges leave now.
  void lay(Impact& push);
  /// Of the places of contact, these alone are left.
  void keep(const std::vector<int>& places);
  /// After a break, with places that lie as far on as `laid` says, and modes that do not.
  void renew(const BodyImpact& impact, Impact& push);
};

}  // namespace topple::structure
