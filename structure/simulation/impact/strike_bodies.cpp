// Bodies that come upon each other or upon the ground: the law of impact (impact.h) says which of their joints fail, at
// the instant and with the speeds at which they meet, before the collision world moves them.
//
// Each side gives way by its own flexibility as a free body (free_segment.h); chunks, balls and the ground are rigid.
// What breaks takes its energy out of the approach, the parts that are left go on, and when nothing more fails the
// collision world has the rest: where nothing breaks an impact leaves no trace here.
//
// What stands and moves is struck where it is: the part that is hit gives way between its nodes, and these nodes move
// by modes while all others are held, so that a joint bears what the push brings to it in the time that it lasts.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "model/index_of.h"
#include "simulation/debris/local_capacity.h"
#include "simulation/debris/momentum.h"
#include "simulation/impact/body_impacts.h"
#include "simulation/impact/impact_settings.h"

namespace topple::structure {

namespace {

/// A joint that bears so much less than it can, relative to that, has not come to it by rounding.
constexpr double rounding = 1e-9;

/// The fastest first, those that are alike as they are: of places that move as one the first is kept.
std::vector<int> by_closing_speed(const Eigen::VectorXd& closing) {
  constexpr double alike = 1e-6;
  const double unit = alike * closing.cwiseAbs().maxCoeff();
  std::vector<int> order(static_cast<std::size_t>(closing.size()));
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return std::round(closing(a) / unit) > std::round(closing(b) / unit); });
  return order;
}

}  // namespace

BodyImpacts::BodyImpacts(const Sources& sources)
    : scene_(sources.scene),
      log_(sources.log),
      sums_(sources.sums),
      debris_(sources.debris),
      break_up_(sources.break_up),
      standing_(sources.standing),
      struck_(sources.struck) {}

/// The contact as it is now: of a body that has fallen apart since it was swept, that of the piece which has the part.
/// Nothing where that is no body any more.
std::optional<collision::Contact> BodyImpacts::contact_now(const collision::Contact& swept) const {
  const auto now = [&](collision::BodyId& id, std::int64_t tag) {
    if (debris_.bodies.contains(id.value)) return true;
    if (tag < 0) return false;
    id = {debris_.body_of_part[static_cast<std::size_t>(tag)]};
    return debris_.bodies.contains(id.value);
  };
  collision::Contact contact = swept;
  if (!now(contact.body, contact.part_tag)) return std::nullopt;
  const bool two = contact.other.kind == collision::Touched::Kind::body;
  if (two && !now(contact.other.body, contact.other.part_tag)) return std::nullopt;
  if (two && contact.other.body == contact.body) return std::nullopt;
  return contact;
}

bool BodyImpacts::comes_hard(const collision::Contact& contact, double dt) const {
  if (strikes(contact)) return true;
  if (!scene_.sways() || contact.other.kind != collision::Touched::Kind::obstacle ||
      contact.approach_speed < impact_settings.lies_down || !debris_.bodies.contains(contact.body.value))
    return false;
  const Part part = debris_.obstacles.part_of(contact.other.obstacle);
  if (!part.valid() || !scene_.stands(part)) return false;
  const double force = debris_.bodies.at(contact.body.value).rest.mass * contact.approach_speed / dt;
  return force > impact_settings.taken_by_contacts * local_capacity(scene_.building, part, scene_.strength_factors);
}

/// Those of one pair at one instant, in order of time; pairs of which nothing can break are left to the collision
/// world. What comes later in the step comes upon the pieces of what broke before.
void BodyImpacts::strike_all(const std::vector<collision::Contact>& contacts, double dt) {
  std::vector<char> done(contacts.size(), 0);
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    if (done[i] != 0 || !comes_hard(contacts[i], dt)) continue;
    const std::optional<collision::Contact> first = contact_now(contacts[i]);
    if (!first) continue;
    const bool two = first->other.kind == collision::Touched::Kind::body;
    const bool on_moving = scene_.sways() && first->other.kind == collision::Touched::Kind::obstacle;
    if (!on_moving && !break_up_.may_fall_apart(first->body) && !(two && break_up_.may_fall_apart(first->other.body)))
      continue;
    if (on_moving && standing_.punch_moving(*first)) continue;
    std::vector<collision::Contact> together;
    for (std::size_t k = i; k < contacts.size(); ++k) {
      if (done[k] != 0 ||
          (k > i && (contacts[k].time - first->time) * contacts[k].approach_speed > impact_settings.touching))
        continue;
      const std::optional<collision::Contact> next = contact_now(contacts[k]);
      if (!next || next->body != first->body || next->other.kind != first->other.kind ||
          next->other.body != first->other.body || (!on_moving && next->other.obstacle != first->other.obstacle))
        continue;
      together.push_back(*next);
      done[k] = 1;
    }
    strike(together, strikes(*first) ? impact_settings.least_speed : impact_settings.lies_down);
  }
}

std::vector<StruckJoint> BodyImpacts::struck_joints(const BodyImpact& impact, const YieldingJoints& yielding) const {
  std::vector<StruckJoint> joints;
  const Eigen::Index n = impact.compliance.rows(), m = impact.sides[1].mode_compliance.size();
  for (const ImpactSide& side : impact.sides)
    for (std::size_t k = 0; k < side.flexibility.demands.size(); ++k) {
      const auto& [joint, columns] = side.flexibility.demands[k];
      Eigen::Matrix<double, 6, Eigen::Dynamic> by_force = Eigen::Matrix<double, 6, Eigen::Dynamic>::Zero(6, n + m);
      by_force.leftCols(n) = columns;
      if (side.held) by_force.rightCols(m) = side.mode_demands[k];
      joints.push_back({joint, &scene_.building[joint].capacity, scene_.strength_factors[index_of(joint)],
                        side.borne[k].second, std::move(by_force)});
      if (!side.held || !yielding.any()) continue;
      // What turns holds its capacity, and changes what others bear.
      StruckJoint& struck = joints.back();
      if (yielding.has(joint)) struck.capacity = &scene_.frame->brittle_capacity(joint);
      if (!(utilisation(*struck.capacity, struck.demand, struck.strength).value < 1)) {
        joints.pop_back();  // over capacity without the impact
        continue;
      }
      struck.with_hinges = yielding.turning();
      yielding.add_to(k, struck);
    }
  return joints;
}

/// Again while places that it left out close, as those of a part do that comes down on one edge and then on the other.
/// What comes back does so the first time. `least_speed`: of a place that closes.
void BodyImpacts::strike(const std::vector<collision::Contact>& contacts, double least_speed) {
  std::optional<std::size_t> told;  // which event tells of it: on what moves always, else once something broke
  Pass pass{least_speed, scene_.scenario.impact.restitution, impact_settings.most_unlike};
  std::vector<collision::Contact> together = contacts;
  while (!together.empty()) {
    BodyImpact impact = impact_of(together);
    if (impact.places.empty() || !push(impact, pass, told)) return;
    pass.restitution = 0;
    pass.most_unlike *= 2;  // what is pinched between two would go to and fro
    // What broke in it left pieces; those of the first place go on.
    const std::vector<collision::Contact> before = std::exchange(together, {});
    for (const collision::Contact& contact : before)
      if (const std::optional<collision::Contact> now = contact_now(contact);
          now &&
          (together.empty() || (now->body == together.front().body && now->other.body == together.front().other.body)))
        together.push_back(*now);
  }
}

BodyImpact BodyImpacts::impact_of(const std::vector<collision::Contact>& contacts) const {
  const collision::Contact& first = contacts.front();
  const bool two = first.other.kind == collision::Touched::Kind::body;
  BodyImpact impact;
  impact.sides[0] = side_at(first.body, time_since_state(first.body, first.time));
  impact.sides[1] = two ? side_at(first.other.body, time_since_state(first.other.body, first.time)) : ImpactSide();
  if (first.other.kind == collision::Touched::Kind::obstacle) {
    impact.sides[1].standing = debris_.obstacles.part_of(first.other.obstacle);
    impact.sides[1].held = scene_.sways();
    if (!scene_.sways() && (!impact.sides[1].standing.valid() || !scene_.stands(impact.sides[1].standing)))
      return impact;  // it broke there
  }
  for (const collision::Contact& contact : contacts) {
    const Part struck_part = impact.sides[1].held ? debris_.obstacles.part_of(contact.other.obstacle) : Part();
    if (impact.sides[1].held && (!struck_part.valid() || !scene_.stands(struck_part))) continue;
    // An area is met at its corners.
    for (int corner = 0; corner < std::max(1, contact.corner_count); ++corner) {
      const Vec3 point = contact.corner_count > 0 ? contact.corners[static_cast<std::size_t>(corner)] : contact.point;
      impact.places.push_back({point, contact.normal});
      impact.sides[0].tags.push_back(contact.part_tag);
      const std::int64_t tag = struck_part.valid() ? part_number(scene_.building, struck_part) : -1;
      impact.sides[1].tags.push_back(two ? contact.other.part_tag : tag);
    }
  }
  return impact;
}

/// Of the places those that push, the fastest first; false: nothing closes, or nothing gives way.
bool BodyImpacts::choose_places(BodyImpact& impact, const Pass& pass) {
  const auto closes = [&](const Eigen::VectorXd& speeds) { return speeds.maxCoeff() >= pass.least_speed; };
  // How what stands moves at the places is known with its response.
  if (!impact.sides[1].held && !closes(closing_speeds(impact.sides[0].motion, impact.sides[1].motion, impact.places)))
    return false;
  if (!prepare_push(impact) || !closes(impact.closing())) return false;
  if (const std::vector<int> order = by_closing_speed(impact.closing()); !std::is_sorted(order.begin(), order.end()))
    impact.keep(order);
  impact.keep(independent_places(impact.compliance));
  if (begin_push(impact, false).fastest_over_slowest() > pass.most_unlike) impact.keep({0});
  return true;
}

/// Whether it left places out which may close still.
bool BodyImpacts::push(BodyImpact& impact, const Pass& pass, std::optional<std::size_t>& told) {
  const std::size_t all_places = impact.places.size();
  if (!choose_places(impact, pass)) return false;
  std::optional<Impact> push = begin_push(impact, true);
  YieldingPush yielding(impact, sums_.ledger.lost_in_impacts);
  const double speed_in = push->closing_speed()(0);
  if (impact.sides[1].held && !told && speed_in >= impact_settings.least_speed) told = record(impact, speed_in);
  bool goes_on = true;
  for (;;) {
    const double deepest = deepest_push(impact);
    const std::vector<StruckJoint> all = struck_joints(impact, yielding.joints);
    Impact borne = *push;
    std::vector<double> uses(all.size(), 0);
    double moment = 0;
    (void)borne.push(
        impact.sides[1].held ? record_utilisations(all, yielding.joints, uses, moment) : Impact::Utilisation(),
        deepest);
    const Eigen::Index n = impact.compliance.rows();
    const StruckJoints joints(all, borne.peak_force(), static_cast<int>(impact.sides[1].mode_compliance.size()));
    const double hardest = borne.peak_force().head(n).maxCoeff();
    const auto used = [&](const Eigen::VectorXd& force) { return joints.utilisation(force); };
    const bool yields = yielding.joints.turning() || moment >= 1;
    const bool bears_all = joints.empty() && !yields;
    if (told) log_[*told].peak_force = std::max(log_[*told].peak_force, bears_all ? hardest : 0);
    if (bears_all ||
        (yields ? yielding.push(*push, used, deepest) : push->push(used, deepest)) != Impact::Stop::failed) {
      for (std::size_t k = 0; k < all.size(); ++k)
        if (uses[k] > 0) scene_.frame->remember_utilisation(all[k].joint, std::min(uses[k], 1.0));
      break;
    }
    if (later(impact, push->impulse().head(n))) break;
    std::vector<JointBreak> broken;
    if (yields && !(joints.utilisation(push->force()) >= 1 - rounding)) {
      broken = yielding.next(*push);
      if (yielding.joints.worn_out()) break;
      if (broken.empty()) continue;
    } else {
      broken = joints.failing(push->force());
    }
    if (!told) told = record(impact, speed_in);
    SimulationEvent& event = log_[*told];
    event.peak_force = std::max(event.peak_force, push->peak_force().head(n).maxCoeff());
    give_impulses(impact, push->extract_impulse().head(n));
    account_turns_of(broken, yielding);
    goes_on = break_joints(impact, *push, yielding, broken);
    log_[*told].speed_out = push->closing_speed()(0);
    if (!goes_on) break;
  }
  if (impact.sides[1].held && goes_on) {
    leave_with_restitution(impact, yielding, pass.restitution);
    if (told) {
      SimulationEvent& event = log_[*told];
      event.peak_force = std::max(event.peak_force, push->peak_force().head(impact.compliance.rows()).maxCoeff());
      event.speed_out = impact.closing()(0);
    }
  }
  keep_turns(yielding);
  return impact.sides[1].held && goes_on && impact.places.size() < all_places;
}

/// Whether what moves makes way before these impulses have acted: all at once they would drive the sides apart. In the
/// push, nodes around the struck parts hold; they would take up in no time what they do in the motion. There the joint
/// is seen to.
bool BodyImpacts::later(const BodyImpact& impact, const Eigen::VectorXd& impulses) {
  return impact.sides[1].held && impulses.dot(impact.mobility_of_both() * impulses) > impulses.dot(impact.closing());
}

/// Fails nothing, and keeps the largest utilisation of each joint of what stands, and the largest moment of its hinges.
Impact::Utilisation BodyImpacts::record_utilisations(const std::vector<StruckJoint>& joints,
                                                     const YieldingJoints& hinges, std::vector<double>& uses,
                                                     double& moment) const {
  return [&](const Eigen::VectorXd& force) {
    if (hinges.any()) moment = std::max(moment, hinges.largest_moment(force));
    for (std::size_t k = 0; k < joints.size(); ++k) {
      const StruckJoint& one = joints[k];
      if (debris_.body_of(one.joint) >= 0) continue;
      const JointCapacity& capacity = scene_.building[one.joint].capacity;
      uses[k] = std::max(uses[k], utilisation(capacity, one.demand + one.step * force, one.strength).value);
    }
    return 0.0;
  };
}

/// m: as far as displacements are small in what is pushed in.
double BodyImpacts::deepest_push(const BodyImpact& impact) const {
  double extent = 0;
  for (const ImpactSide& side : impact.sides) {
    if (side.id.value >= 0) {
      const Bounds& bounds = debris_.bodies.at(side.id.value).bounds;
      extent = std::max(extent, (bounds.high - bounds.low).norm());
      continue;
    }
    const Part part = side.held ? part_of_number(scene_.building, side.tags.front()) : side.standing;
    if (part.member.valid()) extent = std::max(extent, scene_.building[part.member].length);
    if (!part.panel.valid()) continue;
    const Panel& panel = scene_.building[part.panel];
    extent =
        std::max(extent, (scene_.building[panel.nodes[2]].position - scene_.building[panel.nodes[0]].position).norm());
  }
  return impact_settings.small_displacements * extent;
}

/// Nothing more fails: the impulses after which no place closes, and each that was pushed parts with the scenario's
/// share of its closing speed (Newton's law of impact for several contacts; Gauss-Seidel over the places).
/// What hinges took does not come back.
void BodyImpacts::leave_with_restitution(BodyImpact& impact, const YieldingPush& yielding, double restitution) {
  constexpr int most_passes = 1000;
  constexpr double settled = 1e-12;
  const Eigen::MatrixXd mobility = impact.mobility_of_both();
  if (const double took = yielding.joints.work(yielding.joints.left()); took > 0) {
    const Eigen::VectorXd closing = impact.closing().cwiseMax(0.0);
    const double brought = closing.dot(mobility.completeOrthogonalDecomposition().solve(closing)) / 2;
    restitution *= std::sqrt(std::max(0.0, 1 - took / brought));
  }
  const Eigen::VectorXd wanted = (1 + restitution) * impact.closing();
  Eigen::VectorXd impulses = Eigen::VectorXd::Zero(wanted.size());
  for (int pass = 0; pass < most_passes; ++pass) {
    double changed = 0;
    for (Eigen::Index i = 0; i < wanted.size(); ++i) {
      const double before = impulses(i);
      impulses(i) = std::max(0.0, before + (wanted(i) - mobility.row(i).dot(impulses)) / mobility(i, i));
      changed = std::max(changed, std::abs(impulses(i) - before) * mobility(i, i));
    }
    if (changed <= settled * wanted.cwiseAbs().maxCoeff()) break;
  }
  if (impulses.isZero(0)) return;
  give_impulses(impact, impulses);
}

/// `follows`: with the modes of the struck nodes.
Impact BodyImpacts::begin_push(const BodyImpact& impact, bool follows) const {
  const Eigen::Index n = impact.compliance.rows(), bound = follows ? impact.sides[1].mode_compliance.size() : 0;
  Eigen::VectorXd acceleration = Eigen::VectorXd::Zero(n + bound), closing = acceleration;
  closing.head(n) = impact.closing();
  for (std::size_t i = 0; i < impact.places.size(); ++i) {
    // What lies asleep is held up by what it lies on.
    const auto falls = [&](const ImpactSide& side) {
      return side.id.value >= 0 && !side.slept ? scene_.gravity.dot(impact.places[i].normal) : 0.0;
    };
    acceleration(static_cast<Eigen::Index>(i)) = falls(impact.sides[0]) - falls(impact.sides[1]);
  }
  return Impact(impact.followed_mobility().topLeftCorner(n + bound, n + bound),
                impact.followed_compliance().topLeftCorner(n + bound, n + bound), closing, acceleration,
                static_cast<int>(bound));
}

std::size_t BodyImpacts::record(const BodyImpact& impact, double speed_in) {
  const ImpactSide &by = impact.sides[0], &on = impact.sides[1];
  SimulationEvent& event =
      log_.record(SimulationEvent::Kind::impact, on.standing.valid() ? part_name(scene_.building, on.standing)
                                                 : on.id.value < 0   ? "ground"
                                                                     : debris_.name(on.id, on.tags.front()));
  event.body = by.id;
  event.other_body = on.id;
  event.body_name = debris_.bodies.at(by.id.value).name;
  event.mass = debris_.bodies.at(by.id.value).rest.mass;
  event.speed_in = speed_in;
  event.position = impact.places.front().point;
  return log_.size() - 1;
}

/// What the law has done so far becomes velocity of both; the world hears of it.
void BodyImpacts::give_impulses(BodyImpact& impact, const Eigen::VectorXd& impulses) {
  const auto state_of = [](const ImpactSide& side) {
    collision::BodyState state;
    state.pose = side.pose;
    state.velocity = side.motion.velocity;
    state.angular_velocity = side.motion.spin;
    return state;
  };
  const auto measure = [&](Momentum& sum) {
    double kinetic = 0;
    for (const ImpactSide& side : impact.sides) {
      if (side.id.value < 0) continue;
      sum.add(debris_.bodies.at(side.id.value), state_of(side));
      const Kinetic own = kinetic_energy(debris_.bodies.at(side.id.value), state_of(side));
      kinetic += own.translation + own.rotation;
    }
    return kinetic;
  };
  Momentum before{impact.places.front().point}, after{impact.places.front().point};
  const double kinetic = measure(before);
  impact.give(impulses);
  double given = 0;
  if (ImpactSide& held = impact.sides[1]; held.held) {
    given = scene_.frame->strike(held.response, impulses);
    held.response.speed += held.response.mobility * impulses;
  }
  if (impact.sides[1].id.value < 0)
    for (std::size_t i = 0; i < impact.places.size(); ++i)
      before.add_impulse(-impulses(static_cast<Eigen::Index>(i)) * impact.places[i].normal, impact.places[i].point);
  for (ImpactSide& side : impact.sides) {
    set_side(side);
    if (side.id.value >= 0) side = side_again(side, side.id);
  }
  sums_.ledger.lost_in_impacts += kinetic - measure(after) - given;
  sums_.ledger.momentum_error = std::max(sums_.ledger.momentum_error, after.error(before));
}

}  // namespace topple::structure
