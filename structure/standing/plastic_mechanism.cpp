// A mechanism of plastic hinges: they turn under what they hold while the loads do work, until one has turned too far
// or the surplus of work is used up.
#include <algorithm>
#include <cmath>

#include "model/index_of.h"
#include "standing/yielding_way.h"

namespace topple::structure {

namespace {
/// Of the largest rotation in a mechanism: below it a hinge does not turn.
constexpr double no_turn = 1e-6;
}  // namespace

/// The member as a mechanism carries it, without strain.
SolvedMember YieldingWay::carried_along(MemberId member, const FrameMechanism& mechanism) const {
  const auto& nodes = building_[member].nodes;
  return SolvedMember(from_.statics.beam(member), solver::Vec12::Zero(),
                      from_.account.now().rigid_ends(member, mechanism.motion[index_of(nodes[0])],
                                                     mechanism.motion[index_of(nodes[1])]),
                      {});
}

/// `resisted`: what they hold does against a unit of the mechanism, J; `largest` of one of them.
YieldingWay::Turning YieldingWay::turning_in(int c, const FrameMechanism& mechanism, double& resisted,
                                             double& largest) {
  Turning turning;
  double fastest = 0;
  for (PlasticHinge& hinge : ductile_.hinges(c)) {
    if (!hinge.yields || !from_.parts.standing(hinge.joint)) continue;
    const Joint& own = building_[hinge.joint];
    const SolvedMember shape = carried_along(own.member, mechanism);
    const double rate = shape.rigid_end(own.end)(hinge.axis) - shape.end(own.end)(hinge.axis);
    turning.emplace_back(&hinge, rate);
    resisted += rate * hinge.held;
    fastest = std::max(fastest, std::abs(rate));
    largest = std::max(largest, std::abs(rate * hinge.held));
  }
  for (NodeId node : from_.statics.nodes(c)) {
    const Vec6& motion = mechanism.motion[index_of(node)];
    if (from_.parts.stands(node)) fastest = std::max(fastest, motion.tail<3>().cwiseAbs().maxCoeff());
  }
  std::erase_if(turning, [&](const auto& one) { return std::abs(one.second) <= no_turn * fastest; });
  return turning;
}

/// J, of a unit of the mechanism times `sign`.
double YieldingWay::work_of_loads(int c, const FrameMechanism& mechanism, double sign) const {
  double loaded = 0;
  for (NodeId node : from_.statics.nodes(c))
    if (from_.node_solved[index_of(node)]) loaded += sign * from_.loads.on(node).dot(mechanism.motion[index_of(node)]);
  for (MemberId member : from_.statics.members(c))
    if (from_.parts.stands(member) && !from_.applied[index_of(member)].empty())
      loaded += sign * carried_along(member, mechanism).work(from_.applied[index_of(member)], Vec3::UnitZ()).sum();
  return loaded;
}

/// Until one has turned too far, or, where less work is done than resisted, the surplus is used up: true then. `gain`:
/// surplus from a unit of the mechanism, J.
bool YieldingWay::turn_on(int c, const Turning& turning, const FrameMechanism& mechanism, double sign, double gain) {
  PlasticPath& path = ductile_.path(c);
  double amount = unlimited;
  for (const auto& [hinge, rate] : turning)
    amount = std::min(
        amount, std::max(0.0, (hinge->limit - std::copysign(hinge->plastic_rotation, hinge->plastic_rotation * rate)) /
                                  std::abs(rate)));
  const bool arrested = gain < 0 && path.surplus < -gain * amount;
  if (arrested) amount = path.surplus / -gain;
  for (const auto& [hinge, rate] : turning) {
    hinge->plastic_rotation += amount * rate;
    from_.account.change(building_[hinge->joint].member).dissipate(amount * rate * hinge->held);
  }
  ductile_.move_base(c, mechanism.motion, sign * amount);
  path.surplus = std::max(0.0, path.surplus + gain * amount);
  return arrested;
}

/// A mechanism of hinges: they turn under what they hold, while the loads do more work or less, until one has turned
/// too far or the surplus is used up. False when the mechanism is none of theirs.
std::optional<std::vector<JointId>> YieldingWay::swing(int c, const FrameMechanism& mechanism) {
  PlasticPath& path = ductile_.path(c);
  double resisted = 0, largest = 0;
  Turning turning = turning_in(c, mechanism, resisted, largest);
  if (turning.empty()) return std::nullopt;
  const double sign = resisted < 0 ? -1 : 1;
  bool back = false;
  for (auto& [hinge, rate] : turning) {
    rate *= sign;
    if (rate * hinge->held < -no_change * largest) {
      unload(*hinge);
      back = true;
    }
  }
  if (back || ++path.events > most_events * (2 + static_cast<int>(ductile_.hinges(c).size()))) {
    if (!back) hold_all_again(c);
    return std::vector<JointId>();
  }
  const double gain = work_of_loads(c, mechanism, sign) - std::abs(resisted);
  if (turn_on(c, turning, mechanism, sign, gain)) {
    hold_all_again(c);
    give_up_surplus(c);
    return std::vector<JointId>();
  }
  std::vector<JointId> turned_out;
  for (const auto& [hinge, rate] : turning)
    if (std::abs(hinge->plastic_rotation) >= (1 - same_place) * hinge->limit) turned_out.push_back(hinge->joint);
  std::sort(turned_out.begin(), turned_out.end());
  turned_out.erase(std::unique(turned_out.begin(), turned_out.end()), turned_out.end());
  hold_all_again(c);
  return turned_out;
}

}  // namespace topple::structure
