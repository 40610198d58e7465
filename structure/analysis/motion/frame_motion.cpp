#include "analysis/motion/frame_motion.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "analysis/request_checks.h"
#include "model/index_of.h"
#include "model/short_number.h"
#include "topple/solver/modes.h"
#include "topple/structure/error.h"

namespace topple::structure {
namespace {

/// The first substep, s: eight of a sixtieth of a second, and never less than twenty of the lowest period.
constexpr double first_substep = 1.0 / 480;
constexpr double substeps_of_period = 20;
/// Of the lowest period: how long a loss is followed when nothing else is asked for.
constexpr double periods_followed = 2;
constexpr int most_halvings = 8;
constexpr double shortest = 1e-6;  // s: squares of shorter substeps are lost beside stiffness
/// More are refused at first (seven minutes at first_substep), and four times as many are not gone on to.
constexpr double most_substeps = 200'000;
/// Peaks below this share of the largest are measured against it.
constexpr double counts_as = 0.1;

double value_at(const TimeHistory& history, const std::vector<double>& values, double time) {
  const auto after = std::upper_bound(history.times.begin(), history.times.end(), time);
  if (after == history.times.begin()) return time < history.times.front() ? 0 : values.front();
  const auto k = static_cast<std::size_t>(after - history.times.begin());
  if (after == history.times.end()) return time > history.times.back() ? 0 : values.back();
  const double share = (time - history.times[k - 1]) / (history.times[k] - history.times[k - 1]);
  return values[k - 1] + share * (values[k] - values[k - 1]);
}

/// The largest change of b against a, as a share of each or of a tenth of the largest.
double change_of(const std::vector<double>& a, const std::vector<double>& b) {
  double largest = 0, change = 0;
  for (const double value : b) largest = std::max(largest, value);
  if (largest == 0) return 0;
  for (std::size_t i = 0; i < b.size(); ++i)
    change = std::max(change, std::abs(b[i] - a[i]) / std::max(b[i], counts_as * largest));
  return change;
}

}  // namespace

FrameMotion::FrameMotion(const Building& whole, const DividedBuilding& divided, const DamagedFrame& frame,
                         CombinationId combination, const MotionRequest& request)
    : whole_(whole),
      divided_(divided),
      frame_(frame),
      request_(request),
      moving_(frame.moving_frame(given_masses(whole, combination))) {}

void FrameMotion::load(solver::FrameDynamics& frame) const {
  for (std::size_t b = 0; b < moving_.beam_loads.size(); ++b) {
    if (moving_.beam_loads[b].empty() || !frame_.stands(MemberId(b))) continue;
    frame.set_beam_loads(static_cast<int>(b), moving_.beam_loads[b]);
  }
  for (std::size_t n = 0; n < moving_.node_loads.size(); ++n)
    if (!moving_.node_loads[n].isZero(0)) frame.set_node_load(static_cast<int>(n), moving_.node_loads[n]);
}

std::vector<int> FrameMotion::add_history(const TimeHistory& history, solver::FrameDynamics& frame) const {
  std::vector<int> patterns;
  for (const TimeHistory::Series& series : history.series) {
    if (series.axis >= 0) {
      patterns.push_back(frame.add_ground_acceleration(Vec3::Unit(series.axis)));
      continue;
    }
    patterns.push_back(frame.add_pattern(frame_.loads_of_case(series.load_case)));
  }
  return patterns;
}

std::vector<JointId> FrameMotion::joints_of_divided() const {
  std::vector<JointId> joints(request_.joints.size());
  const Building& building = divided_.building();
  for (std::size_t d = 0; d < building.joints.size(); ++d)
    for (std::size_t k = 0; k < joints.size(); ++k)
      if (divided_.joint(JointId(d)) == request_.joints[k]) joints[k] = JointId(d);
  return joints;
}

std::unique_ptr<MotionPeaks> FrameMotion::follow(const MotionStart& start, MotionResult& result,
                                                 const solver::RayleighDamping& damping) const {
  solver::DynamicOptions options;
  options.substep = result.substep;
  options.spectral_radius = 1;
  options.damping = damping;
  options.keep_energy = false;
  options.second_order = request_.second_order;
  solver::FrameDynamics frame(moving_.model, moving_.masses, options);
  load(frame);
  frame.set_state(start.displacements, std::vector<Vec6>(start.displacements.size(), Vec6::Zero()));
  const double h = result.substep;
  int holding = -1;
  if (start.held_over > 0) {
    holding = frame.add_holding_force();
    frame.jump_pattern(holding, 1);
  }
  std::vector<int> patterns;
  if (start.history != nullptr) {
    patterns = add_history(*start.history, frame);
    for (std::size_t k = 0; k < patterns.size(); ++k)
      frame.jump_pattern(patterns[k], value_at(*start.history, start.history->series[k].values, 0));
  }
  auto peaks = std::make_unique<MotionPeaks>(divided_, frame_, request_, joints_of_divided(), frame);
  const auto steps = static_cast<long>(std::ceil(result.duration / h - 1e-9));
  for (long n = 1; n <= steps; ++n) {
    const double end = static_cast<double>(n) * h;
    if (holding >= 0) frame.set_pattern(holding, std::max(0.0, 1 - end / start.held_over));
    for (std::size_t k = 0; k < patterns.size(); ++k)
      frame.set_pattern(patterns[k], value_at(*start.history, start.history->series[k].values, end));
    (void)frame.advance();
    peaks->sample(frame);
  }
  result.unsettled = static_cast<long>(frame.counters().unsettled);
  return peaks;
}

/// Rad/s; with second order under the axial forces of the static state that the frame was solved for last.
double FrameMotion::lowest_frequency() const {
  solver::AxialState axial;
  if (request_.second_order) {
    axial.mode = solver::SecondOrder::cubic;
    for (std::size_t b = 0; b < moving_.model.beams.size(); ++b) {
      const solver::Vec12 forces = frame_.analysis().beam_end_forces(static_cast<int>(b));
      axial.first_axial.push_back((forces(6) - forces(0)) / 2);
    }
    axial.loads.resize(moving_.model.beams.size());
  }
  try {
    return solver::natural_modes(moving_.model, moving_.masses, 1, {}, request_.second_order ? &axial : nullptr)
        .modes.front()
        .angular_frequency;
  } catch (const std::invalid_argument&) {
    throw InputError(whole_.file + ": nothing that can move has mass; accepted: weight, masses or densities");
  } catch (const solver::Instability&) {
    if (!request_.second_order) throw;
    throw UnstableModel(whole_.file + ": " + no_displaced_rest);
  }
}

MotionResult FrameMotion::run(const MotionStart& start) const {
  MotionResult result;
  const double first = lowest_frequency();
  solver::DynamicOptions still;
  still.keep_energy = false;
  const double quotient = solver::FrameDynamics(moving_.model, moving_.masses, still).rayleigh_quotient(start.rest);
  const double shape = quotient > 0 ? std::sqrt(quotient) : first;
  const solver::RayleighDamping damping = solver::rayleigh_damping(request_.damping, first, shape);
  result.period = 2 * std::numbers::pi / first;
  result.shape_frequency = shape / (2 * std::numbers::pi);
  result.damping = request_.damping;
  result.duration = start.held_over + periods_followed * result.period;
  if (start.history != nullptr) result.duration = start.history->times.back();
  if (request_.duration) result.duration = *request_.duration;
  result.substep = std::min({first_substep, result.period / substeps_of_period, result.duration});
  if (!(result.duration >= shortest))
    throw InputError(whole_.file + ": followed for " + short_number(result.duration, 3) +
                     " s; accepted: " + short_number(shortest, 3) + " s at least");
  const double substeps = result.duration / result.substep;
  if (!(substeps <= most_substeps))
    throw InputError(whole_.file + ": to follow it for " + short_number(result.duration, 3) + " s takes " +
                     short_number(std::ceil(substeps), 3) + " substeps of " + short_number(result.substep, 3) +
                     " s; accepted: " + short_number(most_substeps, 3) + " at most, by a shorter time (--for)");
  std::unique_ptr<MotionPeaks> peaks = follow(start, result, damping);
  result.change = std::numeric_limits<double>::infinity();
  while (result.change > settled_peak && result.halvings < most_halvings &&
         result.duration / result.substep <= 2 * most_substeps) {
    result.substep /= 2;
    ++result.halvings;
    std::unique_ptr<MotionPeaks> finer = follow(start, result, damping);
    result.change =
        std::max(change_of(peaks->uses(), finer->uses()), change_of(peaks->movements(), finer->movements()));
    peaks = std::move(finer);
  }
  peaks->write_to(whole_, result);
  return result;
}

}  // namespace topple::structure
