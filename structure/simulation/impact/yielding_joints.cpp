#include "simulation/impact/yielding_joints.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>

#include "simulation/impact/first_failure.h"

namespace topple::structure {

namespace {

/// A moment beyond a capacity by this share is over it: rounding starts no hinge.
constexpr double beyond = 1e-9;
/// Of a hinge's elastic stiffness with its nodes held: what it holds grows by so much as it turns, so that a part which
/// hinges alone hold still gives way by a finite amount. Over ten rotations at yield that is 1e-5 of its capacity.
constexpr double hardening = 1e-6;
/// Events (one begins to turn, or unloads), for each hinge; a push that has more is going round in circles and
/// ends: the motion of what stands sees to the rest.
constexpr int most_events = 8;

}  // namespace

void YieldingJoints::find_hinges(const BodyImpact& impact) {
  const ImpactSide& side = impact.sides[1];
  const std::vector<Hinge> before = std::exchange(hinges_, {});
  if (!side.held || side.response.hinges.empty()) return;
  const auto count = static_cast<Eigen::Index>(side.response.hinges.size());
  elastic_ = impact.followed_compliance();
  on_joints_ = side.hinge_demands;
  const Eigen::Index places = impact.compliance.rows(), all = elastic_.rows();
  by_force_ = Eigen::MatrixXd::Zero(count, all);
  by_turn_ = held_ = Eigen::MatrixXd::Zero(count, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const StandingFrame::HeldResponse::Hinge& own = side.response.hinges[static_cast<std::size_t>(i)];
    Hinge hinge;
    hinge.joint = own.joint;
    hinge.axis = own.axis;
    hinge.capacity = own.capacity;
    hinge.limit = own.limit;
    hinge.before = own.plastic_rotation;
    hinge.stiffness = own.stiffness;
    const auto same = [&](const auto& one) { return one.first == own.joint; };
    const auto& demands = side.flexibility.demands;
    const auto k = static_cast<std::size_t>(std::find_if(demands.begin(), demands.end(), same) - demands.begin());
    hinge.alone = side.borne[k].second(own.axis);
    hinge.starts_at = std::max(own.capacity, std::abs(hinge.alone)) * (1 + beyond);
    by_force_.row(i).head(places) = demands[k].second.row(own.axis);
    by_force_.row(i).tail(all - places) = side.mode_demands[k].row(own.axis);
    by_turn_.row(i) = -side.hinge_demands[k].row(own.axis);
    for (Eigen::Index j = 0; j < count; ++j)
      for (const auto& [joint, demand] : side.response.hinges[static_cast<std::size_t>(j)].demands)
        if (joint == own.joint) held_(i, j) = -demand(own.axis);
    for (const Hinge& one : before) {
      if (one.joint != own.joint || one.axis != own.axis) continue;
      hinge.turned = one.turned;
      hinge.dissipated = one.dissipated;
    }
    hinges_.push_back(hinge);
  }
  solve();
}

bool YieldingJoints::has(JointId joint) const {
  return std::any_of(hinges_.begin(), hinges_.end(), [joint](const Hinge& one) { return one.joint == joint; });
}

bool YieldingJoints::turning() const {
  return std::any_of(hinges_.begin(), hinges_.end(), [](const Hinge& one) { return one.holds != 0; });
}

std::vector<Eigen::Index> YieldingJoints::turning_now() const {
  std::vector<Eigen::Index> found;
  for (std::size_t i = 0; i < hinges_.size(); ++i)
    if (hinges_[i].holds != 0) found.push_back(static_cast<Eigen::Index>(i));
  return found;
}

Eigen::VectorXd YieldingJoints::turned_now() const {
  Eigen::VectorXd turned(static_cast<Eigen::Index>(hinges_.size()));
  for (std::size_t i = 0; i < hinges_.size(); ++i) turned(static_cast<Eigen::Index>(i)) = hinges_[i].turned;
  return turned;
}

void YieldingJoints::solve() {
  constant_ = turned_now();
  slope_ = Eigen::MatrixXd::Zero(constant_.size(), by_force_.cols());
  const std::vector<Eigen::Index> turn = turning_now();
  if (turn.empty()) return;
  Eigen::VectorXd others = constant_;
  others(turn).setZero();
  Eigen::MatrixXd resists = by_turn_(turn, turn);
  Eigen::VectorXd moment = -(by_turn_ * others)(turn);
  for (std::size_t k = 0; k < turn.size(); ++k) {
    const Hinge& one = hinges_[static_cast<std::size_t>(turn[k])];
    const auto i = static_cast<Eigen::Index>(k);
    const double hardens = hardening * one.stiffness;
    resists(i, i) += hardens;
    moment(i) += one.alone - one.holds + hardens * one.from;
  }
  const Eigen::LDLT<Eigen::MatrixXd> factor(resists);
  const Eigen::MatrixXd pushed = by_force_(turn, Eigen::all);
  const Eigen::VectorXd start = factor.solve(moment);
  const Eigen::MatrixXd slope = factor.solve(pushed);
  constant_(turn) = start;
  slope_(turn, Eigen::all) = slope;
}

Eigen::MatrixXd YieldingJoints::compliance() const {
  const Eigen::MatrixXd more = by_force_.transpose() * slope_;
  return elastic_ + (more + more.transpose()) / 2;
}

Eigen::VectorXd YieldingJoints::unloaded() const { return by_force_.transpose() * constant_; }

Eigen::VectorXd YieldingJoints::rotations(const Eigen::VectorXd& force) const { return constant_ + slope_ * force; }

Eigen::VectorXd YieldingJoints::moments(const Eigen::VectorXd& force) const {
  Eigen::VectorXd moments = by_force_ * force - by_turn_ * rotations(force);
  for (std::size_t i = 0; i < hinges_.size(); ++i) moments(static_cast<Eigen::Index>(i)) += hinges_[i].alone;
  return moments;
}

void YieldingJoints::add_to(std::size_t joint, StruckJoint& struck) const {
  struck.demand += on_joints_[joint] * constant_;
  struck.step += on_joints_[joint] * slope_;
}

double YieldingJoints::largest_moment(const Eigen::VectorXd& force) const {
  const Eigen::VectorXd moment = moments(force);
  double largest = 0;
  for (std::size_t i = 0; i < hinges_.size(); ++i)
    if (hinges_[i].holds == 0)
      largest = std::max(largest, std::abs(moment(static_cast<Eigen::Index>(i))) / hinges_[i].starts_at);
  return largest;
}

double YieldingJoints::use(const Eigen::VectorXd& force, const Eigen::VectorXd& rate) const {
  double use = largest_moment(force);
  if (!turning()) return use;
  const Eigen::VectorXd turned = rotations(force), turns = slope_ * rate;
  for (std::size_t i = 0; i < hinges_.size(); ++i) {
    const Hinge& one = hinges_[i];
    const auto k = static_cast<Eigen::Index>(i);
    if (one.holds == 0) continue;
    if (one.holds * turns(k) < 0) return 2;
    use = std::max(use, std::abs(one.before + turned(k)) / one.limit);
  }
  return use;
}

void YieldingJoints::turn(const Eigen::VectorXd& force) {
  const Eigen::VectorXd turned = rotations(force);
  for (std::size_t i = 0; i < hinges_.size(); ++i) {
    Hinge& one = hinges_[i];
    if (one.holds == 0) continue;
    const double now = turned(static_cast<Eigen::Index>(i));
    one.dissipated += one.holds * (now - one.turned);
    one.turned = now;
  }
}

std::vector<JointBreak> YieldingJoints::next(const Eigen::VectorXd& force, const Eigen::VectorXd& rate) {
  ++events_;
  std::vector<JointBreak> broken;
  for (const Hinge& one : hinges_) {
    if (one.holds == 0 || !(std::abs(one.before + one.turned) >= (1 - beyond) * one.limit)) continue;
    if (!broken.empty() && broken.back().joint == one.joint) continue;
    broken.push_back(impact_break(one.joint, {1, static_cast<Sense>(one.axis + 1), std::abs(one.holds), one.capacity}));
  }
  std::sort(broken.begin(), broken.end(), [](const JointBreak& a, const JointBreak& b) { return a.joint < b.joint; });
  if (!broken.empty()) return broken;
  const Eigen::VectorXd moment = moments(force), turns = slope_ * rate;
  bool begins = false;
  for (std::size_t i = 0; i < hinges_.size(); ++i) {
    Hinge& one = hinges_[i];
    const double held = moment(static_cast<Eigen::Index>(i));
    if (one.holds != 0 || !(std::abs(held) >= (1 - beyond / 2) * one.starts_at)) continue;
    one.holds = held;
    one.from = one.turned;
    begins = true;
  }
  if (!begins) {
    // The one that turns back; by rounding it may stand still.
    Hinge* back = nullptr;
    double least = 0;
    for (std::size_t i = 0; i < hinges_.size(); ++i) {
      Hinge& one = hinges_[i];
      if (one.holds == 0) continue;
      const double ahead =
          std::copysign(turns(static_cast<Eigen::Index>(i)), turns(static_cast<Eigen::Index>(i)) * one.holds);
      if (back && ahead >= least) continue;
      back = &one;
      least = ahead;
    }
    if (back) {
      back->starts_at = std::max(back->starts_at, std::abs(back->holds)) * (1 + beyond);
      back->holds = 0;
    }
  }
  solve();
  return {};
}

void YieldingJoints::hold() {
  for (Hinge& one : hinges_) one.holds = 0;
  solve();
}

bool YieldingJoints::worn_out() const { return events_ > most_events * static_cast<int>(2 + hinges_.size()); }

std::vector<StandingFrame::ImpactTurn> YieldingJoints::left() const {
  constexpr int most_passes = 1000;
  constexpr double settled = 1e-12;
  const Eigen::VectorXd whole = turned_now();
  Eigen::VectorXd left = whole;
  for (int pass = 0; pass < most_passes; ++pass) {
    double changed = 0;
    for (std::size_t i = 0; i < hinges_.size(); ++i) {
      const Hinge& one = hinges_[i];
      const auto k = static_cast<Eigen::Index>(i);
      if (whole(k) == 0) continue;
      const double moment = one.alone - held_.row(k).dot(left), bears = std::max(one.capacity, std::abs(one.alone));
      if (std::abs(moment) <= bears) continue;
      const double before = left(k), wanted = before + (moment - std::copysign(bears, moment)) / one.stiffness;
      left(k) = std::clamp(wanted, std::min(0.0, whole(k)), std::max(0.0, whole(k)));
      changed = std::max(changed, std::abs(left(k) - before) / std::abs(whole(k)));
    }
    if (changed <= settled) break;
  }
  std::vector<StandingFrame::ImpactTurn> turns = this->turns();
  for (StandingFrame::ImpactTurn& turn : turns) {
    std::size_t i = 0;
    while (hinges_[i].joint != turn.joint || hinges_[i].axis != turn.axis) ++i;
    const auto k = static_cast<Eigen::Index>(i);
    if (whole(k) != 0) turn.dissipated *= left(k) / whole(k);
    turn.turned = left(k);
  }
  return turns;
}

std::vector<StandingFrame::ImpactTurn> YieldingJoints::turns() const {
  std::vector<StandingFrame::ImpactTurn> turns;
  for (const Hinge& one : hinges_)
    if (one.dissipated != 0) turns.push_back({one.joint, one.axis, one.turned, one.dissipated});
  return turns;
}

double YieldingJoints::work(const std::vector<StandingFrame::ImpactTurn>& turns) const {
  if (hinges_.empty()) return 0;  // what they were before a break is no more
  Eigen::VectorXd turned = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(hinges_.size()));
  double sum = 0;
  for (const StandingFrame::ImpactTurn& turn : turns) {
    sum += turn.dissipated;
    for (std::size_t i = 0; i < hinges_.size(); ++i)
      if (hinges_[i].joint == turn.joint && hinges_[i].axis == turn.axis) {
        turned(static_cast<Eigen::Index>(i)) = turn.turned;
        sum -= hinges_[i].alone * turn.turned;
      }
  }
  return sum + turned.dot(held_ * turned) / 2;
}

}  // namespace topple::structure
