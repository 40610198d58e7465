// The way of a component whose joints turn before they break: from the base (the last state reached) along a straight
// line towards the static answer, from event to event. At each, a hinge forms, or one that would turn back unloads,
// or a joint breaks; then the answer is solved anew.
//
// After a sudden change the loads of the way act at once. They have then done work at their full size, while the
// structure has taken up only what it resists with: the way goes on beyond the static answer, to the first state where
// the two are equal, and comes back from there elastically. With U the energy of the difference between answer and base
// and E the surplus so far, the surplus at a share x of the way is E + 2 U (x - x^2/2). An elastic system comes to x =
// 2; an elastic-plastic spring of ductility m bears 1 - 1/(2 m) of its yield force.
#include <algorithm>
#include <cmath>

#include "model/index_of.h"
#include "simulation/impact/first_failure.h"
#include "standing/yielding_way.h"

namespace topple::structure {

namespace {
/// Of a hinge's rotation limit: one that turns by less over the whole way does not turn.
constexpr double least_turn = 1e-6;
/// Where the base lies closer than this (of the way) to the static answer, that is no direction to go on in.
constexpr double least_way = 1e-6;
}  // namespace

/// What happens first on the way: at `at` the hinges begin to yield or the joints break. Nothing: at is infinite.
struct YieldingWay::NextEvent {
  double at = unlimited;
  std::vector<PlasticHinge*> yielding;
  std::vector<JointId> breaking;

  void consider(double place, PlasticHinge* hinge, JointId joint) {
    if (place > at + same_place * std::max(1.0, at)) return;
    if (place < at - same_place * std::max(1.0, at)) *this = {};
    at = std::min(at, place);
    if (hinge != nullptr) yielding.push_back(hinge);
    if (joint.valid()) breaking.push_back(joint);
  }
};

YieldingWay::YieldingWay(Sources sources)
    : building_(sources.parts.building()),
      from_(std::move(sources)),
      ductile_(building_, from_.statics, from_.parts.segments, from_.parts.bearings, from_.applied) {}

double YieldingWay::capacity(const PlasticHinge& hinge) const {
  return building_[hinge.joint].capacity.value[static_cast<std::size_t>(hinge.sense())] *
         from_.joints.strength(hinge.joint);
}

void YieldingWay::turned_in_motion(int c, std::size_t number, double plastic_rotation, double held) {
  PlasticHinge& hinge = ductile_.hinges(c)[number];
  hinge.plastic_rotation = plastic_rotation;
  (void)from_.account.change(building_[hinge.joint].member);  // its next state of rest is another one
  from_.joints.remember(hinge.joint, 1);
  report_yield(hinge, held);
}

void YieldingWay::lay_rotations(int c) {
  for (PlasticHinge& hinge : ductile_.hinges(c)) {
    const Joint& own = building_[hinge.joint];
    const Eigen::Index place = 6 * own.end + hinge.axis;
    if (from_.statics.plastic_rotations(own.member)(place) != hinge.plastic_rotation) unload(hinge);
  }
}

bool YieldingWay::yields_in_answer(int c) {
  const std::vector<PlasticHinge>& all = ductile_.hinges(c);
  return std::any_of(all.begin(), all.end(), [&](const PlasticHinge& hinge) {
    return from_.parts.standing(hinge.joint) &&
           std::abs(from_.joints.demand(hinge.joint)(hinge.axis)) > (1 + no_change) * capacity(hinge);
  });
}

double YieldingWay::demand_in_base(const PlasticHinge& hinge) const {
  return from_.joints.reference(hinge.joint)(hinge.axis);
}

double YieldingWay::plastic_rotation_in_answer(const PlasticHinge& hinge) const {
  const Joint& own = building_[hinge.joint];
  const SolvedMember shape = from_.account.now().shape(own.member);
  return shape.rigid_end(own.end)(hinge.axis) - shape.end(own.end)(hinge.axis) - hinge.held / own.stiffness(hinge.axis);
}

void YieldingWay::report_yield(PlasticHinge& hinge, double held) {
  if (hinge.told) return;
  hinge.told = true;
  JointBreak line;
  line.joint = hinge.joint;
  line.cause = BreakCause::overload;
  line.sense = hinge.sense();
  line.demand = line.capacity = std::abs(held);
  line.generation = from_.generation;
  line.position = from_.parts.position(hinge.joint);
  yielded_.push_back(line);
}

void YieldingWay::let_yield(PlasticHinge& hinge, double held) {
  const Joint& own = building_[hinge.joint];
  hinge.yields = true;
  hinge.held = held;
  from_.statics.let_yield(own.member, own.end, hinge.axis, held);
  from_.joints.remember(hinge.joint, 1);
  report_yield(hinge, held);
}

void YieldingWay::unload(PlasticHinge& hinge) {
  const Joint& own = building_[hinge.joint];
  hinge.yields = false;
  hinge.held = 0;
  from_.statics.unload(own.member, own.end, hinge.axis, own.stiffness(hinge.axis), hinge.plastic_rotation);
}

void YieldingWay::hold_all_again(int c) {
  for (PlasticHinge& hinge : ductile_.hinges(c))
    if (hinge.yields) unload(hinge);
}

/// The base moves on; `energy`: of the whole way.
void YieldingWay::move_base(int c, double part, double energy) {
  PlasticPath& path = ductile_.path(c);
  for (PlasticHinge& hinge : ductile_.hinges(c)) {
    if (!hinge.yields) continue;
    const double turned = part * path.direction * (plastic_rotation_in_answer(hinge) - hinge.plastic_rotation);
    from_.account.change(building_[hinge.joint].member).dissipate(hinge.held * turned);
    hinge.plastic_rotation += turned;
  }
  for (JointId joint : from_.components.joints[static_cast<std::size_t>(c)])
    if (from_.parts.standing(joint)) {
      from_.joints.move_reference(joint, part * path.direction);
      from_.joints.remember(joint, from_.joints.used(joint, from_.joints.reference(joint)).value);
    }
  ductile_.move_base(c, part * path.direction);
  path.surplus = std::max(0.0, path.surplus + 2 * energy * (path.direction * part - part * part / 2));
  if (path.direction > 0 && part > 1) path.direction = -1;
}

/// How far the way goes when nothing else happens.
double YieldingWay::end_of_way(int c, double energy) {
  const PlasticPath& path = ductile_.path(c);
  if (!path.active) return from_.sudden;
  if (path.returning || from_.sudden == 1) return 1;
  return energy > 0 ? path.direction + std::sqrt(1 + path.surplus / energy) : 0;
}

/// Hinges that would turn against what they hold unload. True when there were any.
bool YieldingWay::turn_back(int c) {
  const double direction = ductile_.path(c).direction;
  bool found = false;
  for (PlasticHinge& hinge : ductile_.hinges(c)) {
    if (!hinge.yields) continue;
    const double turned = direction * (plastic_rotation_in_answer(hinge) - hinge.plastic_rotation);
    if (!(turned * hinge.held < -no_change * hinge.limit * std::abs(hinge.held))) continue;
    unload(hinge);
    found = true;
  }
  return found;
}

YieldingWay::NextEvent YieldingWay::find_next_event(int c) {
  const double direction = ductile_.path(c).direction;
  const auto borne = [&](JointId joint, const Vec6& demand) {
    return structure::utilisation(from_.joints.brittle_capacity(joint), demand, from_.joints.strength(joint)).value < 1;
  };
  NextEvent next;
  for (PlasticHinge& hinge : ductile_.hinges(c)) {
    if (!from_.parts.standing(hinge.joint)) continue;
    if (hinge.yields) {
      const double turning = direction * (plastic_rotation_in_answer(hinge) - hinge.plastic_rotation);
      const double left = hinge.limit - std::copysign(hinge.plastic_rotation, turning * hinge.plastic_rotation);
      if (std::abs(turning) > least_turn * hinge.limit)
        next.consider(std::max(0.0, left / std::abs(turning)), nullptr, hinge.joint);
      continue;
    }
    const double bears = capacity(hinge), from = demand_in_base(hinge),
                 change = direction * (from_.joints.demand(hinge.joint)(hinge.axis) - from);
    if (std::abs(from) > (1 + no_change) * bears)
      next.consider(0, &hinge, {});
    else if (std::abs(change) > no_change * bears)
      next.consider(std::max(0.0, (bears - std::copysign(from, from * change)) / std::abs(change)), &hinge, {});
  }
  for (JointId joint : from_.components.joints[static_cast<std::size_t>(c)]) {
    if (!from_.parts.standing(joint)) continue;
    const Vec6& from = from_.joints.reference(joint);
    const Vec6 change = direction * (from_.joints.demand(joint) - from);
    // Convex along the way: borne at both ends is borne between them.
    if (next.at < unlimited && borne(joint, from) && borne(joint, from + next.at * change)) continue;
    const double at = failing_force(from_.joints.brittle_capacity(joint), from_.joints.strength(joint), from, change);
    if (at < unlimited) next.consider(std::max(0.0, at), nullptr, joint);
  }
  std::sort(next.breaking.begin(), next.breaking.end());
  next.breaking.erase(std::unique(next.breaking.begin(), next.breaking.end()), next.breaking.end());
  return next;
}

YieldingWay::End YieldingWay::follow(int c, std::vector<JointId>& breaking) {
  if (!ductile_.any(c) && !ductile_.path(c).active) return End::unyielding;
  PlasticPath& path = ductile_.path(c);
  for (;;) {
    if (path.active && turn_back(c)) {
      from_.bring_up_to_date();
      ++path.events;
      continue;
    }
    NextEvent next = find_next_event(c);
    const bool measured = from_.sudden != 1 && !path.returning;
    const double energy = measured && (path.active || !next.yielding.empty()) ? ductile_.difference_energy(c) : 0;
    const double end = end_of_way(c, energy);
    if (!path.active && (next.yielding.empty() || next.at > end)) return End::unyielding;
    if (next.at > end) {
      if (end_reached(c, end, energy, measured)) return End::resting;
      continue;
    }
    double at = next.at;
    if (std::abs(at - 1) < least_way && path.direction > 0 && measured) at = 1 - least_way;
    const bool limit = ++path.events > most_events * (2 + static_cast<int>(ductile_.hinges(c).size()));
    path.active = true;
    move_base(c, at, energy);
    if (limit)
      for (const PlasticHinge* hinge : next.yielding) next.breaking.push_back(hinge->joint);
    if (!next.breaking.empty()) {
      hold_all_again(c);  // which of them turn on is seen once these are broken
      breaking.insert(breaking.end(), next.breaking.begin(), next.breaking.end());
      return End::breaking;
    }
    start_yielding(c, next, breaking);
    if (!breaking.empty()) {
      hold_all_again(c);
      return End::breaking;
    }
    from_.bring_up_to_date();
  }
}

/// The way ends before anything happens on it. `measured`: it went as far as the work of what acts suddenly takes it,
/// and the answer lies back from there. True: the answer is reached.
bool YieldingWay::end_reached(int c, double end, double energy, bool measured) {
  move_base(c, end, energy);
  hold_all_again(c);
  give_up_surplus(c);
  from_.bring_up_to_date();
  if (measured) return false;
  ductile_.path(c) = {};
  return true;
}

/// What acts suddenly has done all the work that it had to do: from here the way goes back to the answer.
void YieldingWay::give_up_surplus(int c) {
  PlasticPath& path = ductile_.path(c);
  path.returning = true;
  path.surplus = 0;
  path.direction = 1;
}

/// Hinges at their capacity begin to turn. Those that share a member or a node one after the other: the first may be
/// enough for both.
void YieldingWay::start_yielding(int c, const NextEvent& next, std::vector<JointId>& breaking) {
  const PlasticPath& path = ductile_.path(c);  // one that comes to a stop may turn it round
  std::vector<MemberId> members;
  std::vector<NodeId> nodes;
  for (PlasticHinge* hinge : next.yielding) {
    const Joint& own = building_[hinge->joint];
    const NodeId node = building_[own.member].nodes[static_cast<std::size_t>(own.end)];
    if (std::find(members.begin(), members.end(), own.member) != members.end()) continue;
    if (std::find(nodes.begin(), nodes.end(), node) != nodes.end()) continue;
    members.push_back(own.member);
    nodes.push_back(node);
    const double bears = capacity(*hinge);
    const double towards = path.direction * (from_.joints.demand(hinge->joint)(hinge->axis) - demand_in_base(*hinge));
    const double now = demand_in_base(*hinge);
    const double held = std::copysign(bears, std::abs(now) > no_change * bears ? now : towards);
    if (from_.parts.segments.holds(building_.joint(own.member, 1 - own.end)))
      let_yield(*hinge, held);
    else if (turns_out_alone(*hinge, held))
      breaking.push_back(hinge->joint);
  }
}

/// A member that only this joint holds swings about it: the joint's moment in the answer is what its loads turn it
/// with. True when it turns too far; else it has come to a stop and unloads.
bool YieldingWay::turns_out_alone(PlasticHinge& hinge, double held) {
  const Joint& own = building_[hinge.joint];
  PlasticPath& path = ductile_.path(from_.components.of(hinge.joint));
  const double gain = std::copysign(1.0, held) * from_.joints.demand(hinge.joint)(hinge.axis) - std::abs(held);
  const double left = std::max(0.0, hinge.limit - std::copysign(hinge.plastic_rotation, hinge.plastic_rotation * held));
  const double amount = gain < 0 ? std::min(left, path.surplus / -gain) : left;
  report_yield(hinge, held);
  from_.joints.remember(hinge.joint, 1);
  hinge.plastic_rotation += std::copysign(amount, held);
  from_.account.change(own.member).dissipate(amount * std::abs(held));
  path.surplus = std::max(0.0, path.surplus + gain * amount);
  if (amount >= left) return true;
  unload(hinge);
  hold_all_again(from_.components.of(hinge.joint));
  give_up_surplus(from_.components.of(hinge.joint));
  return false;
}

}  // namespace topple::structure
