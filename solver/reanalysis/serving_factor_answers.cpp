// Solves over the factor in service and its correction.
#include <utility>

#include "assembly/scaled_equations.h"
#include "reanalysis/serving_factor.h"

namespace topple::solver {
namespace {

/// Answers to unit forces weigh impacts, which are known far less well.
constexpr double response_error = 1e-11;
/// Over a structure that became this much softer than the factor's one refinement is made.
constexpr double soft = 1e3;

/// Rows in which v is not zero.
std::vector<int> rows_in(const Eigen::VectorXd& v) {
  std::vector<int> rows;
  for (Eigen::Index row = 0; row < v.size(); ++row)
    if (v(row) != 0) rows.push_back(static_cast<int>(row));
  return rows;
}

}  // namespace

LinearSolve ServingFactor::linear_solve() const {
  return [this](Eigen::Ref<Eigen::MatrixXd> b) {
    if (!corrected()) {
      factor_->solve(b);
      return;
    }
    Eigen::VectorXd x;
    for (Eigen::Index j = 0; j < b.cols(); ++j) {
      x = b.col(j);
      base_->solve(x);
      b.col(j) = x;
    }
  };
}

bool ServingFactor::is_soft() const { return corrected() && base_->softening() >= soft; }

double ServingFactor::count_answer(int solves) {
  if (!base_) return 0;
  const double solve = base_->solve_cost(), correction = base_->correction_cost();
  const double more = solve + residual_cost(static_cast<double>(system_.matrix().value.size()));
  correction_paid_ += solves * correction + (solves - 1) * more;
  return solves * (solve + correction);
}

double ServingFactor::solve(Eigen::VectorXd& x) {
  if (x.size() == 0) return 0;
  if (!base_) {
    Eigen::MatrixXd columns = x;
    factor_->solve(columns);
    x = columns.col(0);
    return 0;
  }
  if (!is_soft()) {
    base_->solve(x);
    return count_answer(1);
  }
  const Eigen::VectorXd right_hand_side = x;
  base_->solve(x);
  (void)rows_->residual(system_.matrix(), right_hand_side, x, left_over_);
  base_->solve(left_over_);
  x += left_over_;
  return count_answer(2);
}

Eigen::VectorXd ServingFactor::refine_to(double limit, const Eigen::VectorXd& right_hand_side, Eigen::VectorXd x,
                                         double& error) const {
  Eigen::VectorXd r, better;
  error = rows_->residual(system_.matrix(), right_hand_side, x, r);
  for (int step = 0; step < most_refinement_steps && error > limit; ++step) {
    base_->solve(r);
    better = x + r;
    const double next = rows_->residual(system_.matrix(), right_hand_side, better, r);
    const bool go_on = next <= worthwhile_refinement * error;
    if (next < error) {
      x.swap(better);
      error = next;
    }
    if (!go_on) break;
  }
  return x;
}

Eigen::VectorXd ServingFactor::respond_alone(const Eigen::VectorXd& force, double& error) const {
  error = 0;
  if (system_.dofs().equations == 0) return {};
  const Eigen::VectorXd right_hand_side = scaled_force(system_, force);
  if (!base_) {
    const RefinedSolution refined = solve_refined(system_.matrix(), linear_solve(), right_hand_side);
    error = refined.quality[0].backward_error;
    return refined.x.col(0).cwiseProduct(scale_of(system_));
  }
  const std::vector<int> loaded = rows_in(right_hand_side);
  Eigen::VectorXd x = right_hand_side;
  base_->solve(x, &loaded);
  return refine_to(response_error, right_hand_side, std::move(x), error).cwiseProduct(scale_of(system_));
}

/// Rows in which any column is not zero.
std::vector<int> ServingFactor::scale_columns(const Eigen::MatrixXd& force, Eigen::MatrixXd& scaled) const {
  const Eigen::Index n = system_.dofs().equations;
  scaled = scale_of(system_).asDiagonal() * force.topRows(n);
  std::vector<int> loaded;
  for (Eigen::Index row = 0; row < n; ++row)
    if ((scaled.row(row).array() != 0).any()) loaded.push_back(static_cast<int>(row));
  return loaded;
}

Eigen::MatrixXd ServingFactor::respond(const Eigen::MatrixXd& force, std::vector<double>& errors) const {
  const Eigen::Index n = system_.dofs().equations, count = force.cols();
  errors.assign(static_cast<std::size_t>(count), 0.0);
  Eigen::MatrixXd X(n, count);
  if (!base_ || n == 0 || count == 1) {
    for (Eigen::Index j = 0; j < count; ++j)
      X.col(j) = respond_alone(force.col(j), errors[static_cast<std::size_t>(j)]);
    return X;
  }
  Eigen::MatrixXd scaled;
  const std::vector<int> loaded = scale_columns(force, scaled);
  X = scaled;
  base_->solve(X, loaded);
  for (Eigen::Index j = 0; j < count; ++j)
    X.col(j) = refine_to(response_error, scaled.col(j), X.col(j), errors[static_cast<std::size_t>(j)])
                   .cwiseProduct(scale_of(system_));
  return X;
}

Eigen::MatrixXd ServingFactor::respond_on_paths(const Eigen::MatrixXd& force, std::span<const int> nodes,
                                                std::vector<char>& known) const {
  const Eigen::Index n = system_.dofs().equations;
  known.assign(static_cast<std::size_t>(n), 1);
  if (!base_ || n == 0) {
    std::vector<double> errors;
    return respond(force, errors);
  }
  Eigen::MatrixXd X;
  std::vector<int> near = scale_columns(force, X);
  for (const int node : nodes)
    for (const int equation : system_.dofs().number[static_cast<std::size_t>(node)])
      if (equation < n) near.push_back(equation);
  base_->solve_on_paths(X, near, known);
  return scale_of(system_).asDiagonal() * X;
}

}  // namespace topple::solver
