#include "simulation/impact/struck_joints.h"
#include "simulation/impact/impact_settings.h"

#include <algorithm>

#include "simulation/impact/first_failure.h"

namespace topple::structure {

namespace {

Utilisation used(const StruckJoint& one, const Eigen::VectorXd& force) {
  return structure::utilisation(*one.capacity, one.demand + one.step * force, one.strength);
}
}  // namespace

StruckJoints::StruckJoints(std::vector<StruckJoint> all, const Eigen::VectorXd& most, int bound) {
  std::vector<double> now;
  std::vector<Eigen::VectorXd> slopes;
  for (StruckJoint& one : all) {
    if (!one.capacity->breakable) continue;
    const double before = structure::utilisation(*one.capacity, one.demand, one.strength).value;
    if (!(before < 1) && !one.with_hinges) continue;
    Eigen::VectorXd slope(most.size());
    for (Eigen::Index place = 0; place < most.size(); ++place) {
      slope(place) = structure::utilisation(*one.capacity, Vec6(one.step.col(place)), one.strength).value;
      if (place < most.size() - bound) continue;
      const double other = structure::utilisation(*one.capacity, Vec6(-one.step.col(place)), one.strength).value;
      slope(place) = std::max(slope(place), other);
    }
    if (before + slope.dot(most) < 1) continue;
    joints_.push_back(std::move(one));
    now.push_back(before);
    slopes.push_back(std::move(slope));
  }
  now_ = Eigen::Map<const Eigen::VectorXd>(now.data(), static_cast<Eigen::Index>(now.size()));
  slopes_.resize(now_.size(), most.size());
  for (std::size_t i = 0; i < slopes.size(); ++i) slopes_.row(static_cast<Eigen::Index>(i)) = slopes[i].transpose();
}

double StruckJoints::utilisation(const Eigen::VectorXd& force) const {
  const Eigen::VectorXd most = now_ + slopes_ * force.cwiseAbs();
  double below = 0, worst = 0;
  for (Eigen::Index i = 0; i < most.size(); ++i) {
    if (most(i) < 1)
      below = std::max(below, most(i));
    else
      worst = std::max(worst, used(joints_[static_cast<std::size_t>(i)], force).value);
  }
  return worst >= 1 ? worst : std::max(below, worst);
}

std::vector<JointBreak> StruckJoints::failing(const Eigen::VectorXd& force) const {
  std::vector<Utilisation> uses;
  double worst = 0;
  for (const StruckJoint& one : joints_) {
    uses.push_back(used(one, force));
    worst = std::max(worst, uses.back().value);
  }
  std::vector<JointBreak> found;
  for (std::size_t i = 0; i < joints_.size(); ++i)
    if (uses[i].value >= worst * (1 - impact_settings.same_instant))
      found.push_back(impact_break(joints_[i].joint, uses[i]));
  std::sort(found.begin(), found.end(), [](const JointBreak& a, const JointBreak& b) { return a.joint < b.joint; });
  return found;
}

}  // namespace topple::structure
