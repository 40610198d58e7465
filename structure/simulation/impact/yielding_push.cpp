#include "simulation/impact/yielding_push.h"

#include <algorithm>

namespace topple::structure {

YieldingPush::YieldingPush(const BodyImpact& impact, double lost) : lost_before(lost) {
  joints.find_hinges(impact);
  if (joints.any()) laid = joints.unloaded();
}

/// Until an event, with what yields turned as far as it then has.
Impact::Stop YieldingPush::push(Impact& push, const Impact::Utilisation& brittle, double deepest) {
  const Impact::Stop stop =
      push.push_watched([&](const Eigen::VectorXd& force,
                            const Eigen::VectorXd& rate) { return std::max(brittle(force), joints.use(force, rate)); },
                        deepest);
  joints.turn(push.force());
  return stop;
}

void YieldingPush::keep(const std::vector<int>& places) {
  if (joints.any()) laid = Eigen::VectorXd(laid(places));
}

/// After a break, with places that lie as far on as `laid` says, and modes that do not.
void YieldingPush::renew(const BodyImpact& impact, Impact& push) {
  joints.find_hinges(impact);
  if (!joints.any()) return;
  const Eigen::VectorXd places = laid;
  laid = Eigen::VectorXd::Zero(joints.unloaded().size());
  laid.head(places.size()) = places;
  lay(push);
}

/// A hinge begins to turn, or turns no more, and the push goes on with what gives way then; or these joints have turned
/// too far.
std::vector<JointBreak> YieldingPush::next(Impact& push) {
  std::vector<JointBreak> broken = joints.next(push.force(), push.force_rate());
  if (broken.empty()) lay(push);
  return broken;
}

void YieldingPush::lay(Impact& push) {
  const Eigen::VectorXd now = joints.unloaded();
  push.yield(joints.compliance(), now - laid);
  laid = now;
}

}  // namespace topple::structure
