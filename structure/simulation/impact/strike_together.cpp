// One body that comes upon several standing parts at the same instant: it pushes them together (coupled_push.h), break
// after break, until it has come to a stop, they have let go of it, or they are gone.
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <map>

#include "simulation/debris/momentum.h"
#include "simulation/impact/coupled_push.h"
#include "simulation/impact/first_failure.h"
#include "simulation/impact/impact_settings.h"
#include "simulation/impact/push_impulses.h"
#include "simulation/impact/standing_impacts.h"
#include "simulation/step_clock.h"

namespace topple::structure {

namespace {

/// Whether each place gives way in a way of its own.
bool independent(const Eigen::MatrixXd& compliance) {
  Eigen::MatrixXd left = compliance;
  for (Eigen::Index k = 0; k < left.rows(); ++k) {
    if (!(left(k, k) > impact_settings.same_place * compliance(k, k))) return false;
    const Eigen::VectorXd column = left.col(k) / left(k, k);
    left -= (column * left.row(k)).eval();
  }
  return true;
}

/// What unit forces at the places add to one joint.
struct Watched {
  JointId joint;
  double strength = 1;
  Vec6 demand;                                    ///< without the push
  Eigen::Matrix<double, 6, Eigen::Dynamic> step;  ///< per place
};

/// Joints that may come to their capacity under forces up to `most`. A joint's use is convex, so that it is at most the
/// sum of its uses: nearly all of them are told by that.
class WatchedJoints {
 public:
  WatchedJoints(const StandingFrame& frame, const std::vector<StandingFrame::UnitResponse>& places,
                std::span<const double> strength_factors, const Eigen::VectorXd& most);
  [[nodiscard]] bool empty() const { return joints_.empty(); }
  /// Exact from 1 on; below it at least what it is.
  [[nodiscard]] double worst_utilisation(const Eigen::VectorXd& force) const;
  [[nodiscard]] std::vector<JointBreak> failing(const Eigen::VectorXd& force) const;

 private:
  [[nodiscard]] Utilisation use(const Watched& one, const Eigen::VectorXd& force) const {
    return utilisation(building_[one.joint].capacity, one.demand + one.step * force, one.strength);
  }
  const Building& building_;
  std::vector<Watched> joints_;
  Eigen::VectorXd now_;     ///< their uses without the push
  Eigen::MatrixXd slopes_;  ///< and what a unit force at each place adds at most
};

WatchedJoints::WatchedJoints(const StandingFrame& frame, const std::vector<StandingFrame::UnitResponse>& places,
                             std::span<const double> strength_factors, const Eigen::VectorXd& most)
    : building_(frame.building()) {
  std::map<std::int32_t, std::vector<std::pair<Eigen::Index, const Vec6*>>> at_joint;
  for (std::size_t i = 0; i < places.size(); ++i)
    for (const auto& [joint, demand] : places[i].demands)
      at_joint[joint.index].emplace_back(static_cast<Eigen::Index>(i), &demand);
  std::vector<double> now;
  std::vector<Eigen::VectorXd> slopes;
  for (const auto& [index, steps] : at_joint) {
    const JointId id(static_cast<std::size_t>(index));
    const JointCapacity& capacity = building_[id].capacity;
    if (!capacity.breakable || !frame.intact(id)) continue;
    Watched one{id, strength_factors[static_cast<std::size_t>(index)], frame.demand(id),
                Eigen::Matrix<double, 6, Eigen::Dynamic>::Zero(6, most.size())};
    const double used = utilisation(capacity, one.demand, one.strength).value;
    if (used >= 1) continue;  // left to the generations
    Eigen::VectorXd slope = Eigen::VectorXd::Zero(most.size());
    for (const auto& [place, demand] : steps) {
      one.step.col(place) = *demand;
      slope(place) = utilisation(capacity, *demand, one.strength).value;
    }
    if (used + slope.dot(most) < 1) continue;
    joints_.push_back(std::move(one));
    now.push_back(used);
    slopes.push_back(std::move(slope));
  }
  now_ = Eigen::Map<const Eigen::VectorXd>(now.data(), static_cast<Eigen::Index>(now.size()));
  slopes_.resize(now_.size(), most.size());
  for (std::size_t i = 0; i < slopes.size(); ++i) slopes_.row(static_cast<Eigen::Index>(i)) = slopes[i].transpose();
}

double WatchedJoints::worst_utilisation(const Eigen::VectorXd& force) const {
  const Eigen::VectorXd most = now_ + slopes_ * force;
  double below = 0, worst = 0;
  for (Eigen::Index i = 0; i < most.size(); ++i) {
    if (most(i) < 1)
      below = std::max(below, most(i));
    else
      worst = std::max(worst, use(joints_[static_cast<std::size_t>(i)], force).value);
  }
  return worst >= 1 ? worst : std::max(below, worst);
}

std::vector<JointBreak> WatchedJoints::failing(const Eigen::VectorXd& force) const {
  std::vector<Utilisation> uses;
  double worst = 0;
  for (const Watched& one : joints_) {
    uses.push_back(use(one, force));
    worst = std::max(worst, uses.back().value);
  }
  std::vector<JointBreak> found;
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    if (uses[i].value >= worst * (1 - impact_settings.same_instant))
      found.push_back(impact_break(joints_[i].joint, uses[i]));
  }
  return found;
}

}  // namespace

/// The push under way: its contacts, and what they are pushed against.
struct StandingImpacts::SimultaneousImpact {
  std::vector<Strike> hits;
  std::vector<ContactPlace> places;
  std::vector<Vec3> normals;
  PushingBody body;
  std::vector<PushedPlace> pushed_at;
  StandingFrame::CoupledResponse response;
  std::optional<CoupledPush> push;
  CoupledPush::Vec6 rates_out;  ///< velocity and spin with which the body comes out of it

  /// All is borne. It leaves with the restitution's part of what the parts give back; one that its weight holds down
  /// stays.
  void leave(CoupledPush done, CoupledPush::Stop end, double restitution) {
    rates_out = done.rates_at_most_stored();
    if (end == CoupledPush::Stop::left) rates_out += restitution * (done.rates() - rates_out);
    push = std::move(done);
  }
};

/// False when they are better taken one after the other, or are no impacts any more; nothing has happened then.
bool StandingImpacts::strike_together(std::span<const collision::Contact* const> contacts) {
  SimultaneousImpact pushed;
  for (const collision::Contact* contact : contacts) {
    std::optional<Strike> hit = aim(*contact);
    if (!hit) continue;
    if (fracture_.punching_force(*hit) < unlimited) return false;  // what breaks out of a panel leaves alone
    pushed.hits.push_back(std::move(*hit));
  }
  std::vector<Strike>& hits = pushed.hits;
  if (hits.size() < 2) return false;
  for (Strike& hit : hits) {
    hit.state = hits.front().state;
    hit.own_time = hits.front().own_time;
    pushed.places.push_back(hit.place);
    pushed.normals.push_back(hit.normal);
  }
  // What is known at little cost tells of most pushes that they are borne, and of some that they are taken one by one.
  pushed.response = scene_.frame->respond_near(pushed.places, pushed.normals);
  if (!prepare_push(pushed)) return false;
  if (breaks_nothing(pushed)) {
    ++sums_.counters.impacts_bounded;
  } else {
    pushed.response = scene_.frame->respond(pushed.places, pushed.normals);
    if (!prepare_push(pushed)) return false;
    run_impact(pushed);
  }
  ++sums_.counters.impacts_together;
  set_motion_after(pushed);
  for (const Strike& hit : hits) record_impact(hit);
  return true;
}

/// The push against what is known of the structure. False when the places are better taken one after the other.
bool StandingImpacts::prepare_push(SimultaneousImpact& pushed) const {
  std::vector<Strike>& hits = pushed.hits;
  if (!independent(pushed.response.compliance)) return false;
  const Body& one = *hits.front().body;
  const collision::BodyState& state = hits.front().state;
  pushed.body = {one.rest.mass,          world_inertia(one, state.pose.orientation),
                 state.pose.position,    state.velocity,
                 state.angular_velocity, one.rest.mass * scene_.gravity};
  pushed.pushed_at.clear();
  for (const Strike& hit : hits) pushed.pushed_at.push_back({hit.place.point, hit.normal});
  Eigen::MatrixXd share;
  if (scene_.scenario.impact.structure_mass) {
    const Eigen::MatrixXd stiffness = pushed.response.compliance.inverse();
    share = stiffness * pushed.response.inertia * stiffness;
    for (std::size_t i = 0; i < hits.size(); ++i) hits[i].structure_mass = pushed.response.places[i].rayleigh_mass;
  }
  pushed.push.emplace(pushed.body, pushed.pushed_at, pushed.response.compliance, share);
  return pushed.push->fastest_over_slowest() <= impact_settings.most_unlike;
}

/// As for one place (strike.cpp): the joints that bear the push directly do not fail under its peaks, and the strain
/// energy, at most that of all peaks at once, is less than any other joint fails at. Then the push is done.
bool StandingImpacts::breaks_nothing(SimultaneousImpact& pushed) {
  constexpr double rounding = 1e-6;
  CoupledPush borne = *pushed.push;
  const CoupledPush::Stop end = borne.push();
  const Eigen::VectorXd& peak = borne.peak_force();
  if (!WatchedJoints(*scene_.frame, pushed.response.places, scene_.strength_factors, peak).empty()) return false;
  const double stored = peak.dot(pushed.response.compliance.cwiseAbs() * peak) / 2;
  for (const ContactPlace& place : pushed.places)
    if (stored > (1 - rounding) * scene_.frame->critical_energy(place)) return false;
  pushed.leave(std::move(borne), end, scene_.scenario.impact.restitution);
  return true;
}

void StandingImpacts::run_impact(SimultaneousImpact& pushed) {
  CoupledPush& push = *pushed.push;
  for (;;) {
    CoupledPush borne = push;
    const CoupledPush::Stop end = borne.push();
    const WatchedJoints watched(*scene_.frame, pushed.response.places, scene_.strength_factors, borne.peak_force());
    const auto used = [&](const Eigen::VectorXd& force) { return watched.worst_utilisation(force); };
    if (watched.empty()) return pushed.leave(std::move(borne), end, scene_.scenario.impact.restitution);
    if (push.push(used) != CoupledPush::Stop::failed)
      return pushed.leave(CoupledPush(push), end, scene_.scenario.impact.restitution);
    const std::vector<JointBreak> breaks = watched.failing(push.force());
    const double stored = push.stored();
    const Eigen::VectorXd shift = scene_.frame->break_in_impact(breaks, pushed.places, pushed.normals);
    bool stays = false, shifted = false;
    for (std::size_t i = 0; i < pushed.hits.size(); ++i) {
      Strike& hit = pushed.hits[i];
      hit.through = !scene_.stands(hit.part);
      if (hit.through) push.let_go(i);
      stays = stays || push.touches(i);
      shifted = shifted || std::abs(shift(static_cast<Eigen::Index>(i))) > impact_settings.largest_shift;
    }
    const bool ends = !stays || shifted;
    if (!ends) go_on(pushed, shift);
    const double freed = ends ? stored : std::max(0.0, stored - push.stored());
    for (JointBreak broken : breaks) {
      broken.energy = freed / static_cast<double>(breaks.size());
      broken.position = scene_.joint_position(broken.joint);
      pushed.hits.front().breaks.push_back(broken);
    }
    if (ends) {
      pushed.rates_out = push.rates();
      return;
    }
  }
}

/// The structure as the breaks left it. Places that are gone keep a compliance that nothing reads.
void StandingImpacts::go_on(SimultaneousImpact& pushed, const Eigen::VectorXd& shift) {
  std::vector<Eigen::Index> left;
  std::vector<ContactPlace> places;
  std::vector<Vec3> normals;
  for (std::size_t i = 0; i < pushed.hits.size(); ++i) {
    if (pushed.hits[i].through) continue;
    left.push_back(static_cast<Eigen::Index>(i));
    places.push_back(pushed.places[i]);
    normals.push_back(pushed.normals[i]);
  }
  StandingFrame::CoupledResponse now = scene_.frame->respond(places, normals);
  for (StandingFrame::UnitResponse& one : pushed.response.places) one.demands.clear();
  for (std::size_t k = 0; k < left.size(); ++k)
    pushed.response.places[static_cast<std::size_t>(left[k])] = std::move(now.places[k]);
  pushed.response.compliance(left, left) = now.compliance;
  pushed.push->weaken(pushed.response.compliance, shift);
}

void StandingImpacts::set_motion_after(SimultaneousImpact& pushed) {
  Strike& first = pushed.hits.front();
  const Body& one = *first.body;
  std::vector<char> through;
  for (const Strike& hit : pushed.hits) through.push_back(hit.through ? 1 : 0);
  const PushImpulses impulses = impulses_of_push(pushed.body, pushed.pushed_at, pushed.rates_out, through);
  collision::BodyState state = first.state;
  state.velocity += impulses.change.head<3>();
  state.angular_velocity += impulses.change.tail<3>();
  const Kinetic came = kinetic_energy(one, first.state), goes = kinetic_energy(one, state);
  sums_.ledger.lost_in_impacts += (came.translation + came.rotation) - (goes.translation + goes.rotation);
  std::vector<PointImpulse> given;
  for (std::size_t i = 0; i < pushed.hits.size(); ++i) {
    Strike& hit = pushed.hits[i];
    const auto speed = [&](const collision::BodyState& of) {
      return hit.normal.dot(of.velocity + of.angular_velocity.cross(hit.place.point - pushed.body.centre));
    };
    hit.peak_force = pushed.push->peak_force()(static_cast<Eigen::Index>(i));
    hit.speed = speed(first.state);
    hit.speed_out = speed(state);
    if (hit.through) keep_release_impulse(hit);
    given.push_back({impulses.along(static_cast<Eigen::Index>(i)) * hit.normal, hit.place.point});
  }
  // It is stopped where it is as long as one place stands.
  Strike whole = first;
  whole.through = std::find(through.begin(), through.end(), 0) == through.end();
  move_on(whole, state, given);
}

}  // namespace topple::structure
