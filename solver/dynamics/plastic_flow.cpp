// Plastic hinges within a substep. A hinge's plastic rotation is a kink of its beam: constant loads on the beam's nodes
// times its angle, on the stiffness as it was. So the moments at the end of a substep are linear in how far the hinges
// turn in it, M = M_tried - A dtheta with A symmetric and positive definite, and each hinge
//   turns forward only where M = capacity, back only where M = -capacity, not at all between:
// the return mapping of perfect plasticity, all hinges together (J. C. Simo, T. J. R. Hughes, Computational
// Inelasticity, 1998, chapters 1 and 5). Damping acts on elastic rates alone: what yields is not braked by it.
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "dynamics/dynamic_state.h"

namespace topple::solver {
namespace {

/// Of a capacity: what counts as beyond it. Above the rounding of end forces, far below what an engineer sees.
constexpr double beyond = 1e-10;
/// Of its beam's stiffness: a turn that meets less resistance than this falls freely.
constexpr double resistless = 1e-9;
/// Of the largest turn: when turns found one after the other no longer change.
constexpr double settled = 1e-12;
constexpr int most_sweeps = 100000;

double beyond_capacity(double moment, double capacity) {
  if (moment > capacity) return moment - capacity;
  if (moment < -capacity) return moment + capacity;
  return 0;
}

/// Its beam stands, and its joint holds in this component.
bool yields(const FrameSystem& system, const PlasticHinge& hinge) {
  const auto i = static_cast<std::size_t>(hinge.beam);
  return system.beam_stands[i] != 0 &&
         system.model.beams[i].end_stiffness[static_cast<std::size_t>(hinge.end)](hinge.component) > 0;
}

/// The share of the way from one value to another at which it is reached.
double share_at(double from, double to, double value) {
  return to > from ? std::clamp((value - from) / (to - from), 0.0, 1.0) : 1.0;
}

}  // namespace

std::vector<double> FrameDynamics::State::moments_at_end(std::span<const PlasticHinge> hinges) {
  evaluate_end();
  std::vector<double> moments(hinges.size(), 0);
  int beam_read = -1;
  Vec12 forces = Vec12::Zero();
  for (std::size_t h = 0; h < hinges.size(); ++h) {
    if (!yields(system(), hinges[h])) continue;
    if (hinges[h].beam != beam_read) forces = end_forces(hinges[h].beam, true);
    beam_read = hinges[h].beam;
    moments[h] = forces(6 * hinges[h].end + hinges[h].component);
  }
  return moments;
}

namespace {

/// A hinge at its capacity: how far it turns in the substep.
struct Turning {
  std::size_t kink = 0;
  double capacity = 0, tried = 0;  ///< the moment tried, with no hinge turning
  double turn = 0;
};

/// Each in turn, as the others stand: the matrix is definite, so that this comes to the one solution.
void find_turns(const Eigen::MatrixXd& A, std::vector<Turning>& turning) {
  for (int sweep = 0; sweep < most_sweeps; ++sweep) {
    double change = 0, largest = 0;
    for (std::size_t i = 0; i < turning.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      if (A(row, row) == 0) continue;
      double moment = turning[i].tried + A(row, row) * turning[i].turn;
      for (std::size_t j = 0; j < turning.size(); ++j) moment -= A(row, static_cast<Eigen::Index>(j)) * turning[j].turn;
      const double turn = beyond_capacity(moment, turning[i].capacity) / A(row, row);
      change = std::max(change, std::abs(turn - turning[i].turn));
      largest = std::max(largest, std::abs(turn));
      turning[i].turn = turn;
    }
    if (change <= settled * largest) return;
  }
  throw std::runtime_error("how far plastic hinges turn in a substep was not found");
}

}  // namespace

void FrameDynamics::State::yield(std::span<const PlasticHinge> hinges) {
  kinks.hold_nothing();
  if (hinges.empty()) return;
  const std::vector<double> tried = moments_at_end(hinges);
  std::vector<double> moments = tried;
  std::vector<char> listed(hinges.size(), 0);
  std::vector<Turning> turning;
  Eigen::MatrixXd A;
  const auto add = [&](std::size_t h) {
    const std::size_t k =
        kinks.number(system().model, hinges[h].beam, static_cast<std::size_t>(hinges[h].end), hinges[h].component);
    kinks.find(system(), k);
    if (kinks[k].response.size() == 0) {
      Eigen::VectorXd response;
      response = of_new_turn() * kinks[k].force;
      solve_substep(response);
      kinks.set_response(k, std::move(response));
    }
    kinks.set_tried(k, tried[h]);
    listed[h] = 1;
    turning.push_back({k, hinges[h].capacity, tried[h], 0});
    const auto n = static_cast<Eigen::Index>(turning.size()) - 1;
    A.conservativeResize(n + 1, n + 1);
    for (Eigen::Index j = 0; j <= n; ++j)
      A(n, j) = A(j, n) = kinks.resistance(k, turning[static_cast<std::size_t>(j)].kink, method);
    // Nothing holds it but the inertia that a beam on one end does not have: it is over, see turned_out_at().
    if (A(n, n) > resistless * -kinks[k].fixed_end(kinks[k].component_index()) && A(n, n) > 0) return;
    A.row(n).setZero();
    A.col(n).setZero();
  };
  const auto add_those_beyond = [&] {
    const std::size_t count = turning.size();
    for (std::size_t h = 0; h < hinges.size(); ++h)
      if (listed[h] == 0 && std::abs(moments[h]) > (1 + beyond) * hinges[h].capacity) add(h);
    return turning.size() > count;
  };
  const Eigen::VectorXd as_tried = equation.w();
  while (add_those_beyond()) {
    find_turns(A, turning);
    equation.w() = as_tried;
    for (const Turning& one : turning) {
      kinks.turn(one.kink, one.turn, one.capacity);
      if (one.turn != 0) equation.w() += one.turn * kinks[one.kink].response;
    }
    find_end();
    moments = moments_at_end(hinges);
  }
}

std::optional<double> FrameDynamics::State::turned_out_at(const PlasticHinge& hinge) {
  if (!yields(system(), hinge)) return std::nullopt;
  const Kink& kink =
      kinks[kinks.number(system().model, hinge.beam, static_cast<std::size_t>(hinge.end), hinge.component)];
  const auto moment = [&](bool at_end) { return std::abs(end_forces(hinge.beam, at_end)(kink.component_index())); };
  constexpr double rounding = 1e4 * beyond;
  const bool over = moment(true) > (1 + rounding) * hinge.capacity;
  if (!over && !(std::abs(kink.now) > hinge.largest_turn)) return std::nullopt;
  evaluate_nodes();
  const double start = moment(false);
  if (over) return share_at(start, moment(true), hinge.capacity);
  // It begins to turn when it reaches its capacity, and turns evenly from there.
  const double begun = share_at(start, std::abs(kink.tried), hinge.capacity), sign = std::copysign(1.0, kink.now);
  return begun + (1 - begun) * share_at(sign * kink.before, sign * kink.now, hinge.largest_turn);
}

}  // namespace topple::solver
