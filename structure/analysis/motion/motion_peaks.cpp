#include "analysis/motion/motion_peaks.h"

#include <algorithm>
#include <cmath>

#include "model/index_of.h"

namespace topple::structure {
namespace {

/// A substep is looked at in so many parts; where a joint may set its record, the part around the largest use is
/// narrowed down by so many thirds.
constexpr int parts = 4;
constexpr int thirds = 12;

/// Least and largest of a cubic course, with the shares of the substep at which they are.
struct Extremes {
  double low, low_at, high, high_at;
};

Extremes extremes_of(const solver::SubstepCourse<double>& course) {
  Extremes found{course.start, 0, course.start, 0};
  const auto look = [&](double share, double value) {
    if (value < found.low) found.low = value, found.low_at = share;
    if (value > found.high) found.high = value, found.high_at = share;
  };
  look(1, course.end);
  // The rate is a quadratic a s2 + b s + c.
  const double change = course.end - course.start, r0 = course.length * course.start_rate,
               r1 = course.length * course.end_rate;
  const double a = 3 * (r0 + r1 - 2 * change), b = 2 * (3 * change - 2 * r0 - r1), c = r0;
  const auto look_at = [&](double share) {
    if (share > 0 && share < 1) look(share, course.at(share));
  };
  if (a == 0) {
    if (b != 0) look_at(-c / b);
    return found;
  }
  const double discriminant = b * b - 4 * a * c;
  if (discriminant < 0) return found;
  const double q = -(b + std::copysign(std::sqrt(discriminant), b)) / 2;
  look_at(q / a);
  if (q != 0) look_at(c / q);
  return found;
}

/// A motion of the solver as a DamagedFrame reads it: the end of the last substep, or the rates there.
class AtEnd : public DamagedFrame::Motion {
 public:
  AtEnd(const std::vector<solver::Vec12>& forces, const solver::FrameDynamics& frame,
        const std::vector<Vec6>& displacements, bool of_rates)
      : forces_(forces), frame_(frame), displacements_(displacements) {
    rates = of_rates;
  }
  [[nodiscard]] solver::Vec12 beam_end_forces(int beam) const override {
    return forces_[static_cast<std::size_t>(beam)];
  }
  [[nodiscard]] std::array<Vec6, 4> shell_corner_forces(int shell) const override {
    return frame_.shell_corner_forces(shell, rates);
  }
  [[nodiscard]] const std::vector<Vec6>& displacements() const override { return displacements_; }

 private:
  const std::vector<solver::Vec12>& forces_;
  const solver::FrameDynamics& frame_;
  const std::vector<Vec6>& displacements_;
};

/// Tension positive, moments as members' diagrams have them at their first end.
Vec6 at_first_end(const solver::Vec12& forces) { return -forces.head<6>(); }

}  // namespace

MotionPeaks::MotionPeaks(const DividedBuilding& divided, const DamagedFrame& frame, const MotionRequest& request,
                         std::vector<JointId> joints, solver::FrameDynamics& motion)
    : divided_(divided), frame_(frame), request_(request), wanted_(std::move(joints)) {
  read(motion, now_);
  for (const JointId joint : holding_)
    joints_.push_back({joint, utilisation(divided_.building()[joint].capacity, now_.demand[index_of(joint)]),
                       now_.demand[index_of(joint)], 0});
  for (std::size_t m = 0; m < now_.forces.size(); ++m) {
    const MemberId member = divided_.member(MemberId(m));
    if (!frame_.stands(MemberId(m)) || divided_.pieces(member).front() != MemberId(m)) continue;
    MemberMotion own;
    own.member = member;
    const Vec6 forces = at_first_end(now_.forces[m]);
    for (std::size_t c = 0; c < 6; ++c) own.min[c] = own.max[c] = {forces(static_cast<Eigen::Index>(c)), 0};
    members_.push_back(own);
  }
  for (const Vec6& u : now_.displacements) largest_.push_back(u.cwiseAbs());
  sample_now();
}

void MotionPeaks::read(const solver::FrameDynamics& motion, State& state) const {
  state.displacements = motion.displacements();
  state.velocities = motion.velocities();
  const std::size_t count = divided_.building().members.size();
  state.forces.resize(count);
  state.force_rates.resize(count);
  for (std::size_t m = 0; m < count; ++m) {
    if (!frame_.stands(MemberId(m))) {
      state.forces[m].setZero();
      state.force_rates[m].setZero();
      continue;
    }
    state.forces[m] = motion.beam_end_forces(static_cast<int>(m));
    state.force_rates[m] = motion.beam_end_force_rates(static_cast<int>(m));
  }
  frame_.read_demands(AtEnd(state.force_rates, motion, state.velocities, true), state.rate, holding_);
  frame_.read_demands(AtEnd(state.forces, motion, state.displacements, false), state.demand, holding_);
}

void MotionPeaks::sample(const solver::FrameDynamics& motion) {
  std::swap(before_, now_);
  read(motion, now_);
  const double length = motion.substep();
  sample_joints(length);
  sample_members(length);
  sample_nodes(length);
  time_ += length;
  sample_now();
}

void MotionPeaks::sample_joints(double length) {
  for (JointState& own : joints_) {
    const std::size_t j = index_of(own.joint);
    const solver::SubstepCourse<Vec6> course{before_.demand[j], before_.rate[j], now_.demand[j], now_.rate[j], length};
    const JointCapacity& capacity = divided_.building()[own.joint].capacity;
    const auto utilisation_at = [&](double share) { return utilisation(capacity, course.at(share)); };
    double best = 0, largest = -1;
    for (int k = 0; k <= parts; ++k) {
      const double share = static_cast<double>(k) / parts, value = utilisation_at(share).value;
      if (value > largest) largest = value, best = share;
    }
    constexpr double near_record = 0.9;
    if (largest < near_record * own.utilisation.value) continue;
    double low = std::max(0.0, best - 1.0 / parts), high = std::min(1.0, best + 1.0 / parts);
    for (int k = 0; k < thirds; ++k) {
      const double a = low + (high - low) / 3, b = high - (high - low) / 3;
      (utilisation_at(a).value < utilisation_at(b).value ? low : high) =
          utilisation_at(a).value < utilisation_at(b).value ? a : b;
    }
    const double middle = (low + high) / 2;
    if (utilisation_at(middle).value > largest) best = middle;
    const Utilisation use = utilisation_at(best);
    if (!(use.value > own.utilisation.value)) continue;
    own.utilisation = use;
    own.demand = course.at(best);
    own.at = time_ + best * length;
  }
}

void MotionPeaks::sample_members(double length) {
  for (MemberMotion& own : members_) {
    const std::size_t m = index_of(divided_.pieces(own.member).front());
    const Vec6 start = at_first_end(before_.forces[m]), start_rate = at_first_end(before_.force_rates[m]),
               end = at_first_end(now_.forces[m]), end_rate = at_first_end(now_.force_rates[m]);
    for (Eigen::Index c = 0; c < 6; ++c) {
      const Extremes found = extremes_of({start(c), start_rate(c), end(c), end_rate(c), length});
      InTime &low = own.min[static_cast<std::size_t>(c)], &high = own.max[static_cast<std::size_t>(c)];
      if (found.low < low.value) low = {found.low, time_ + found.low_at * length};
      if (found.high > high.value) high = {found.high, time_ + found.high_at * length};
    }
  }
}

void MotionPeaks::sample_nodes(double length) {
  for (std::size_t n = 0; n < largest_.size(); ++n)
    for (Eigen::Index c = 0; c < 6; ++c) {
      const Extremes found = extremes_of({before_.displacements[n](c), before_.velocities[n](c),
                                          now_.displacements[n](c), now_.velocities[n](c), length});
      largest_[n](c) = std::max({largest_[n](c), found.high, -found.low});
    }
}

void MotionPeaks::sample_now() {
  if (request_.nodes.empty() && wanted_.empty()) return;
  MotionSample sample;
  sample.time = time_;
  for (const NodeId node : request_.nodes) sample.displacements.push_back(now_.displacements[index_of(node)]);
  for (const JointId joint : wanted_) {
    const bool holds = std::find(holding_.begin(), holding_.end(), joint) != holding_.end();
    sample.demands.push_back(holds ? now_.demand[index_of(joint)] : Vec6::Zero());
    sample.uses.push_back(holds ? utilisation(divided_.building()[joint].capacity, sample.demands.back()).value : 0);
  }
  history_.push_back(std::move(sample));
}

std::vector<double> MotionPeaks::uses() const {
  std::vector<double> values;
  for (const JointState& own : joints_) values.push_back(own.utilisation.value);
  return values;
}

std::vector<double> MotionPeaks::movements() const {
  std::vector<double> values;
  for (const Vec6& u : largest_)
    for (Eigen::Index c = 0; c < 3; ++c) values.push_back(u(c));
  return values;
}

void MotionPeaks::write_to(const Building& whole, MotionResult& result) const {
  for (const JointState& own : joints_)
    if (const JointId joint = divided_.joint(own.joint); joint.valid())
      result.joints.push_back({joint, own.utilisation, own.demand, own.at, std::nullopt});
  result.members = members_;
  result.displacements.assign(largest_.begin(), largest_.begin() + static_cast<std::ptrdiff_t>(whole.nodes.size()));
  result.history = history_;
}

}  // namespace topple::structure
