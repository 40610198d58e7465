#include "assembly/mechanism.h"
#include "assembly/frame_recovery.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "assembly/refinement.h"

namespace topple::solver {
namespace {

/// A pivot above this is beyond what rounding makes of a zero one in any model of 32-bit size; below it the condition
/// is estimated before the structure is called stable.
constexpr double suspicious_pivot = 1e-8;
/// A reciprocal condition counts as singular this much below the limit for pivots: a condition of 1e13 still leaves
/// digits, while that of a singular matrix is 1e16.
constexpr double condition_margin = 1e-2;
/// Stiffness added to every scaled freedom for inverse iteration, and the factor by which it grows when that fails.
constexpr double first_shift = 1e-11, shift_growth = 100;
constexpr int inverse_iterations = 6;
/// Nodes that move less than this share of the largest motion do not count as moving.
constexpr double moving_share = 1e-6;

double mean_beam_length(const FrameModel& model) {
  double sum = 0;
  for (const Beam& beam : model.beams) sum += beam.length;
  return model.beams.empty() ? 1 : sum / static_cast<double>(model.beams.size());
}

void normalise(Mechanism& mechanism, double length) {
  double translation = 0, rotation = 0;
  for (const Vec6& u : mechanism.motion) {
    translation = std::max(translation, u.head<3>().norm());
    rotation = std::max(rotation, u.tail<3>().norm());
  }
  const bool turns_only = translation < moving_share * rotation * length;
  const double scale = turns_only ? rotation : translation;
  if (!(scale > 0)) return;
  std::vector<double> size(mechanism.motion.size());
  for (std::size_t n = 0; n < size.size(); ++n) {
    mechanism.motion[n] /= scale;
    const Vec6& u = mechanism.motion[n];
    size[n] = turns_only ? u.tail<3>().norm() : u.head<3>().norm();
    const bool turns = u.tail<3>().norm() * (turns_only ? 1.0 : length) > moving_share;
    if (size[n] > moving_share || turns) mechanism.nodes.push_back(static_cast<int>(n));
  }
  std::stable_sort(mechanism.nodes.begin(), mechanism.nodes.end(),
                   [&](int a, int b) { return size[static_cast<std::size_t>(a)] > size[static_cast<std::size_t>(b)]; });
}

std::string describe(const Mechanism& mechanism) {
  if (mechanism.nodes.empty()) return "unstable: the stiffness matrix is singular";
  const Vec6& u = mechanism.motion[static_cast<std::size_t>(mechanism.nodes[0])];
  const bool turns = u.head<3>().cwiseAbs().maxCoeff() < moving_share;
  Eigen::Index axis = 0;
  (turns ? Vec3(u.tail<3>()) : Vec3(u.head<3>())).cwiseAbs().maxCoeff(&axis);
  static const std::array<const char*, 3> axes{"x", "y", "z"};
  std::string text = "unstable: node " + std::to_string(mechanism.nodes[0]) +
                     (turns ? " turns about " : " moves along ") + axes[static_cast<std::size_t>(axis)] +
                     " without resistance";
  const std::span<const int> others = std::span(mechanism.nodes).subspan(1);
  if (!others.empty()) text += ", and with it " + list_nodes(others);
  return text;
}

bool factorise_shifted(const SparseSymmetric& K, Factor& factor) {
  for (double shift = first_shift; shift < 1; shift *= shift_growth) {
    SparseSymmetric stiffened = K;
    for (std::size_t column = 0; column < static_cast<std::size_t>(K.size); ++column) {
      stiffened.value[static_cast<std::size_t>(K.start[column])] += shift;
    }
    if (factor.factorise(stiffened).positive_definite) return true;
  }
  return false;
}

}  // namespace

Defect motion_defect(const FrameSystem& system, const Eigen::VectorXd& scaled_motion) {
  Defect defect;
  Eigen::VectorXd u(scaled_motion.size());
  for (Eigen::Index i = 0; i < u.size(); ++i) u(i) = scaled_motion(i) * system.scale()[static_cast<std::size_t>(i)];
  defect.motion.motion = node_displacements(system, u, Eigen::VectorXd::Zero(system.dofs().held));
  normalise(defect.motion, mean_beam_length(system.model));
  defect.message = describe(defect.motion);
  return defect;
}

Defect find_mechanism(const FrameSystem& system, Factor& factor, int row) {
  const SparseSymmetric& K = system.matrix();
  Eigen::MatrixXd z = Eigen::MatrixXd::Zero(K.size, 1);
  if (factorise_shifted(K, factor)) {
    // From a unit vector the iteration converges to that row's own part of the null space, not to a mixture of all
    // motions.
    z(std::clamp(row, 0, K.size - 1), 0) = 1;
    for (int i = 0; i < inverse_iterations; ++i) {
      factor.solve(z);
      z /= z.norm();
    }
  }
  return motion_defect(system, z.col(0));
}

void judge_condition(const AnalysisOptions& options, double condition, Stability& stability) {
  stability.condition = condition;
  if (1 / condition < options.warning_limit) stability.nearly_unstable = true;
}

Stability factorise_and_judge(const FrameSystem& system, Factor& factor, const AnalysisOptions& options) {
  Stability result;
  const SparseSymmetric& K = system.matrix();
  if (K.size == 0) return result;
  const Factor::Outcome outcome = factor.factorise(K);
  result.least_pivot = outcome.worst_pivot;
  if (!outcome.positive_definite || outcome.worst_pivot < options.singular_limit) {
    result.defect = find_mechanism(system, factor, outcome.worst_row);
    return result;
  }
  result.nearly_unstable = outcome.worst_pivot < options.warning_limit;
  if (outcome.worst_pivot < suspicious_pivot) {
    judge_condition(options, estimate_condition(K, [&](auto b) { factor.solve(b); }), result);
    if (1 / result.condition < condition_margin * options.singular_limit) {
      result.defect = find_mechanism(system, factor, outcome.worst_row);
    }
  }
  return result;
}

}  // namespace topple::solver
