// Impacts on what stands and moves: how it answers a push with its struck nodes held, and what the impact's impulses,
// turned hinges and breaks do to it.
#include <algorithm>
#include <cmath>
#include <span>

#include "standing/beam_as_it_holds.h"
#include "standing/held_push.h"
#include "standing/standing_state.h"
#include "topple/solver/held_beam.h"
#include "topple/structure/error.h"

namespace topple::structure {

namespace {

/// Of the modes of one more component.
void add_modes(int component, StandingMotion::LocalMotion local, const std::vector<Eigen::Index>& places,
               StandingFrame::HeldResponse& answer) {
  const solver::LocalModes& modes = local.modes;
  const Eigen::Index before = answer.squared.size(), own = modes.squared.size();
  answer.squared.conservativeResize(before + own);
  answer.squared.tail(own) = modes.squared;
  answer.pushed.conservativeResize(before + own, answer.compliance.cols());
  answer.pushed.bottomRows(own).setZero();
  answer.pushed.bottomRows(own)(Eigen::all, places) = modes.pushed;
  for (auto& [joint, columns] : answer.node_demands) {
    columns.conservativeResize(6, before + own);
    columns.rightCols(own).setZero();
  }
  for (const auto& [joint, columns] : local.demands) {
    Eigen::Matrix<double, 6, Eigen::Dynamic> wide = Eigen::Matrix<double, 6, Eigen::Dynamic>::Zero(6, before + own);
    wide.rightCols(own) = columns;
    answer.node_demands.emplace_back(joint, std::move(wide));
  }
  answer.local.emplace_back(component, std::move(local.modes));
}

}  // namespace

StandingFrame::HeldResponse StandingFrame::respond_held(std::span<const ContactPlace> places,
                                                        std::span<const Vec3> directions) {
  State& state = *state_;
  HeldResponse answer =
      HeldPush({state.parts, state.shells, state.statics, state.response}).respond(places, directions);
  answer.pushed.resize(0, static_cast<Eigen::Index>(places.size()));
  for (const auto& [c, own] : state.contacts_by_component(answer)) {
    state.motion->start(c);
    state.motion->pass_on_motion(c);
    std::vector<StandingMotion::NodalForces> forces;
    for (const Eigen::Index i : own) forces.push_back(answer.at_nodes[static_cast<std::size_t>(i)]);
    answer.mobility(own, own) = state.motion->mobility(c, forces);
    for (const Eigen::Index i : own)
      for (const auto& [node, force] : answer.at_nodes[static_cast<std::size_t>(i)])
        answer.speed(i) += force.dot(state.motion->velocity(node));
    add_modes(c, state.motion->local_motion(c, forces), own, answer);
    state.add_hinges(c, answer);
  }
  state.pending = true;
  return answer;
}

double StandingFrame::strike(const HeldResponse& pushed, const Eigen::VectorXd& impulses) {
  State& state = *state_;
  double work = 0;
  for (const auto& [c, own] : state.contacts_by_component(pushed)) {
    if (!state.motion->moves(c)) continue;  // nothing of it stands any more
    StandingMotion::NodalForces given;
    for (const Eigen::Index i : own)
      for (const auto& [node, force] : pushed.at_nodes[static_cast<std::size_t>(i)])
        given.emplace_back(node, impulses(i) * force);
    work += state.motion->strike(c, given);
  }
  return work;
}

void StandingFrame::remember_utilisation(JointId joint, double value) { state_->joints.remember(joint, value); }

const JointCapacity& StandingFrame::brittle_capacity(JointId joint) const {
  return state_->joints.brittle_capacity(joint);
}

double StandingFrame::turn_in_impact(std::span<const ImpactTurn> turns) {
  State& state = *state_;
  double work = 0;
  for (const ImpactTurn& one : turns) {
    const MemberId member = state.building[one.joint].member;
    const int c = state.statics.component(member);
    if (!state.parts.standing(one.joint) || !state.motion->moves(c)) continue;
    const std::vector<PlasticHinge>& hinges = state.yielding.hinges(c);
    for (std::size_t h = 0; h < hinges.size(); ++h)
      if (hinges[h].joint == one.joint && hinges[h].axis == one.axis)
        work += state.motion->turn_at_once(c, h, one.turned, one.dissipated);
    const solver::Vec12 end_forces = state.motion->end_forces(member);
    for (int end = 0; end < 2; ++end)
      if (const JointId joint = state.building.joint(member, end); state.parts.standing(joint))
        state.joints.set_demand(joint, member_joint_demand(end_forces, end));
  }
  return work;
}

void StandingFrame::break_in_impact(std::span<const JointBreak> breaks) {
  State& state = *state_;
  for (const JointBreak& one : breaks) {
    if (!state.parts.standing(one.joint)) continue;
    state.joints.remember(one.joint, 1);
    state.damage.let_go(one.joint);
  }
  state.follow_breaks();
  take_changes();  // the push goes on against what is left
  state.pending = true;
}

/// Hinges of joints of one component that the push reaches. A joint that alone holds its member has none: between held
/// nodes nothing but mass, which is at the nodes, would say how it turns.
void StandingFrame::State::add_hinges(int component, HeldResponse& answer) {
  constexpr double no_hold = 1e-9;  // of the stiffness of a bar
  std::vector<JointId> alone;
  const auto reached = [&](JointId joint) {
    const auto same = [joint](const auto& one) { return one.first == joint; };
    return std::any_of(answer.demands.begin(), answer.demands.end(), same) ||
           std::any_of(answer.node_demands.begin(), answer.node_demands.end(), same);
  };
  for (const PlasticHinge& hinge : yielding.hinges(component)) {
    if (!parts.standing(hinge.joint) || !reached(hinge.joint)) continue;
    const Joint& own = building[hinge.joint];
    solver::BeamLoad angle;  // a kink at its end
    angle.kind = solver::BeamLoad::Kind::temperature;
    (own.end == 0 ? angle.first : angle.last)(hinge.axis) = 1;
    const solver::Beam beam = beam_as_it_holds(statics, parts, own.member);
    const solver::Vec12 held = solver::hold_beam(beam, {&angle, 1}).end_forces;
    const double stiffness = -held(6 * own.end + hinge.axis);
    if (!(stiffness > no_hold * beam.youngs_modulus * (beam.Iy + beam.Iz) / beam.length)) {
      alone.push_back(hinge.joint);
      continue;
    }
    HeldResponse::Hinge& found = answer.hinges.emplace_back();
    found.joint = hinge.joint;
    found.axis = hinge.axis;
    found.capacity = yielding.capacity(hinge);
    found.limit = hinge.limit;
    found.plastic_rotation = hinge.plastic_rotation;
    found.stiffness = stiffness;
    for (int end = 0; end < 2; ++end)
      found.demands.emplace_back(building.joint(own.member, end), member_joint_demand(held, end));
  }
  std::erase_if(answer.hinges, [&](const HeldResponse::Hinge& hinge) {
    return std::find(alone.begin(), alone.end(), hinge.joint) != alone.end();
  });
}

std::map<int, std::vector<Eigen::Index>> StandingFrame::State::contacts_by_component(const HeldResponse& pushed) const {
  std::map<int, std::vector<Eigen::Index>> by;
  for (std::size_t i = 0; i < pushed.at_nodes.size(); ++i)
    if (!pushed.at_nodes[i].empty())
      by[statics.component(pushed.at_nodes[i].front().first)].push_back(static_cast<Eigen::Index>(i));
  return by;
}

}  // namespace topple::structure
