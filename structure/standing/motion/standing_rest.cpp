// How motion ends: whether it is near to rest, and the energies that it leaves to the accounts.
#include <algorithm>

#include "model/beam_load_sums.h"
#include "model/index_of.h"
#include "standing/beam_as_it_holds.h"
#include "standing/motion/moving_component.h"
#include "topple/solver/held_beam.h"

namespace topple::structure {

namespace {

/// J, on the way to rest, of what loads do between nodes. The strain of members that left went with them. Loads that
/// came or went at once bent a member between its nodes by themselves, which leaves as much strain as they do work too
/// much. Where a member holds otherwise by now, its nodes bear other shares of its loads, and these moved between
/// nodes: by the shares, at the places of the start, and by twice the strain that is there more.
double freed_between_nodes(const MotionSources& from, int c) {
  const StateOfRest& start = from.account.at_rest();
  double freed = 0;
  for (const MemberId member : from.statics.members(c)) {
    if (!start.stands(member)) continue;
    const solver::Beam before = start.beam(member);
    if (!from.parts.stands(member)) {
      freed += solver::held_strain_energy(before, start.loads(member));
      continue;
    }
    const std::vector<solver::BeamLoad>& loads = from.statics.loads(member);
    const solver::Beam now = beam_as_it_holds(from.statics, from.parts, member);
    const std::vector<solver::BeamLoad>& were = start.loads(member);
    if (!same_loads(loads, were)) {
      std::vector<solver::BeamLoad> more = loads;
      add_scaled(were, -1, more);
      freed += solver::held_strain_energy(before, more);
    }
    if (loads.empty() || (now.end_stiffness == before.end_stiffness && now.youngs_modulus == before.youngs_modulus))
      continue;
    freed += solver::held_strain_energy(now, loads) - solver::held_strain_energy(before, loads);
    const solver::HeldBeam held = solver::hold_beam(now, loads), was_held = solver::hold_beam(before, loads);
    for (std::size_t end = 0; end < 2; ++end)
      freed += (held.on_nodes[end] - was_held.on_nodes[end]).dot(start.displacement(from.building[member].nodes[end]));
  }
  return freed;
}

}  // namespace

/// What it still has beyond its static state is damped now: 1/2 v'Mv + 1/2 d'Kd, d the way to that state.
void StandingMotion::settle(int c) {
  Moving& moving = *moving_.at(c);
  const double of_present = moving.frame->work_of_present_loads();
  moving.left_work = moving.frame->energy().external_work - of_present;
  past_.damped += moving.frame->energy().kinetic;
  const std::vector<Vec6> rest = model_.at_rest(c);
  moving.left_work += moving.frame->geometric_work_to(rest);
  std::vector<Vec6> way = moving.frame->displacements();
  for (const NodeId node : from_.statics.nodes(c)) {
    const auto n = static_cast<std::size_t>(from_.statics.number(node));
    way[n] = from_.node_solved[index_of(node)] != 0 ? Vec6(way[n] - rest[n]) : Vec6(Vec6::Zero());
  }
  const solver::DynamicEnergy before = moving.frame->energy();
  for (const PlasticHinge& hinge : from_.yielding.hinges(c)) {  // the way bends no hinge
    const Joint& own = from_.building[hinge.joint];
    if (hinge.plastic_rotation != 0)
      moving.frame->set_plastic_rotation(from_.statics.number(own.member), own.end, hinge.axis, 0);
  }
  moving.frame->set_state(way, std::vector<Vec6>(way.size(), Vec6::Zero()));
  past_.damped += moving.frame->energy().elastic;
  past_.freed += before.freed - moving.frame->energy().freed;  // what setting the state took for a change
  past_.freed += freed_between_nodes(from_, c);
  stop(c);
}

bool StandingMotion::check_rest(int c) const {
  const Moving& moving = *moving_.at(c);
  return moving.frame->time() - moving.looked >= settings_.rest_looks;
}

/// How far each joint is from its static demand, and how fast it goes over the lowest frequency: in one mode together
/// no less than the amplitude, and more in a higher one.
bool StandingMotion::rests(int c) {
  Moving& moving = *moving_.at(c);
  moving.looked = moving.frame->time();
  const double slowest = damping_.first_frequency(c);
  const std::vector<Vec6>&u = moving.frame->displacements(), &v = moving.frame->velocities();
  for (const NodeId node : from_.statics.nodes(c)) {
    if (from_.node_solved[index_of(node)] == 0) continue;
    const auto n = static_cast<std::size_t>(from_.statics.number(node));
    const double off = (u[n] - from_.statics.displacement(node)).head<3>().norm() + v[n].head<3>().norm() / slowest;
    if (!(off <= settings_.rest_displacement)) return false;
  }
  for (const MemberId member : from_.statics.members(c)) {
    if (!from_.parts.stands(member)) continue;
    const int beam = from_.statics.number(member);
    const solver::Vec12 off = moving.frame->beam_end_forces(beam) - from_.statics.end_forces(member);
    const solver::Vec12 rate = moving.frame->beam_end_force_rates(beam);
    for (int end = 0; end < 2; ++end) {
      const JointId joint = from_.building.joint(member, end);
      if (!from_.building[joint].capacity.breakable || !from_.parts.standing(joint)) continue;
      Vec6 most = member_joint_demand(off, end).cwiseAbs() + member_joint_demand(rate, end).cwiseAbs() / slowest;
      for (int sign = 0; sign < 2; ++sign) {
        if (!(from_.joints.used(joint, most).value <= settings_.rest_utilisation)) return false;
        most(0) = -most(0);
      }
    }
  }
  return true;
}

MotionEnergy StandingMotion::energy() const {
  MotionEnergy sum = past_;
  for (const auto& [c, moving] : moving_) {
    const solver::DynamicEnergy& own = moving->frame->energy();
    sum.kinetic += own.kinetic;
    sum.elastic_change += own.elastic - moving->elastic_at_start;
    sum.damped += own.damped;
    sum.numerical += own.numerical;
    sum.external_work += own.external_work;
    sum.struck += own.struck;
    sum.freed += own.freed;
    sum.dissipated += own.dissipated;
  }
  return sum;
}

}  // namespace topple::structure
