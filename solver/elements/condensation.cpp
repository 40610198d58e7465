#include "elements/condensation.h"

#include <algorithm>
#include <stdexcept>

#include "factor/multiple_right_hand_sides.h"

namespace topple::solver {

namespace {

using Panel = Eigen::Map<const Eigen::MatrixXd>;

/// Columns of L of one front.
Panel panel_of(const MultifrontalFactor& factor, std::size_t front) {
  const Supernodes& fronts = factor.fronts();
  return {factor.values().data() + fronts.value_start[front], fronts.rows(front), fronts.columns(front)};
}

Eigen::MatrixXd times_transpose(const Eigen::MatrixXd& matrix) {
  const int n = static_cast<int>(matrix.rows());
  const Eigen::MatrixXd rows = matrix.transpose();
  Eigen::MatrixXd minus = Eigen::MatrixXd::Zero(n, n);
  for (int j = 0; j < n; ++j) subtract_combination(matrix.data(), n, n, n, rows.col(j).data(), minus.col(j).data());
  return -minus;
}

}  // namespace

Condensation::Condensation(const SparseSymmetric& pattern, int inner, const std::vector<int>& order)
    : inner_(inner), size_(pattern.size) {
  if (std::any_of(order.begin(), order.begin() + inner, [&](int row) { return row >= inner; }))
    throw std::invalid_argument("condensation: the kept rows are not the last to be eliminated");
  if (pattern.size == 0) return;
  factor_.emplace(pattern, order, 1);
  // Fronts are numbered by subtrees: inner ones may come after kept ones on which they do not depend.
  const Supernodes& fronts = factor_->fronts();
  for (std::size_t f = 0; f < static_cast<std::size_t>(fronts.count()); ++f)
    for (Eigen::Index c = 0; c < fronts.columns(f); ++c) {
      if (is_kept(fronts.first[f] + c)) continue;
      if (!runs_.empty() && runs_.back().front == f && runs_.back().end == c)
        ++runs_.back().end;
      else
        runs_.push_back({f, c, c + 1});
    }
}

bool Condensation::factorise(SparseSymmetric matrix) {
  if (!factor_) return true;
  const Eigen::Index kept = size_ - inner_;
  Eigen::VectorXd added(kept);
  for (Eigen::Index k = 0; k < kept; ++k) {
    double& diagonal = matrix.value[static_cast<std::size_t>(matrix.start[static_cast<std::size_t>(inner_ + k)])];
    added(k) = diagonal > 0 ? diagonal : 1;
    diagonal += added(k);
  }
  if (factor_->factorise(matrix) < size_) return false;
  schur_.resize(kept, kept);
  if (kept == 0) return true;
  const Eigen::MatrixXd product = times_transpose(kept_columns());
  for (Eigen::Index j = 0; j < kept; ++j)
    for (Eigen::Index i = 0; i < kept; ++i) schur_(i, j) = product(std::max(i, j), std::min(i, j));
  schur_.diagonal() -= added;
  return true;
}

/// Of L, in the order that they have in the matrix.
Eigen::MatrixXd Condensation::kept_columns() const {
  const Supernodes& fronts = factor_->fronts();
  Eigen::MatrixXd L = Eigen::MatrixXd::Zero(size_ - inner_, size_ - inner_);
  for (std::size_t f = 0; f < static_cast<std::size_t>(fronts.count()); ++f) {
    const Panel panel = panel_of(*factor_, f);
    const std::int64_t* rows = fronts.row.data() + fronts.row_start[f];
    for (Eigen::Index c = 0; c < panel.cols(); ++c) {
      if (!is_kept(rows[c])) continue;
      for (Eigen::Index i = c; i < panel.rows(); ++i)
        if (is_kept(rows[i])) L(row_at(rows[i]) - inner_, row_at(rows[c]) - inner_) = panel(i, c);
    }
  }
  return L;
}

/// In the order of elimination: inner rows become Lii^-1 fi, kept ones fk - Lki Lii^-1 fi.
Eigen::VectorXd Condensation::forward(const Eigen::VectorXd& loads) const {
  const Supernodes& fronts = factor_->fronts();
  Eigen::VectorXd y(size_), below;
  for (Eigen::Index k = 0; k < size_; ++k) y(k) = loads(row_at(k));
  for (const Run& run : runs_) {
    const Panel L = panel_of(*factor_, run.front);
    const Eigen::Index columns = run.end - run.begin, rest = L.rows() - run.end;
    auto own = y.segment(fronts.first[run.front] + run.begin, columns);
    L.block(run.begin, run.begin, columns, columns).triangularView<Eigen::Lower>().solveInPlace(own);
    below.noalias() = L.block(run.end, run.begin, rest, columns) * own;
    const std::int64_t* rows = fronts.row.data() + fronts.row_start[run.front] + run.end;
    for (Eigen::Index i = 0; i < rest; ++i) y(rows[i]) -= below(i);
  }
  return y;
}

Eigen::VectorXd Condensation::condense(const Eigen::VectorXd& loads) const {
  Eigen::VectorXd result(size_ - inner_);
  if (!factor_) return result;
  const Eigen::VectorXd y = forward(loads);
  for (Eigen::Index k = 0; k < size_; ++k)
    if (is_kept(k)) result(row_at(k) - inner_) = y(k);
  return result;
}

template <class Columns>
void Condensation::back_substitute(Columns& y) const {
  const Supernodes& fronts = factor_->fronts();
  Columns below;
  for (auto run = runs_.rbegin(); run != runs_.rend(); ++run) {
    const Panel L = panel_of(*factor_, run->front);
    const Eigen::Index columns = run->end - run->begin, rest = L.rows() - run->end;
    const std::int64_t* rows = fronts.row.data() + fronts.row_start[run->front] + run->end;
    below.resize(rest, y.cols());
    for (Eigen::Index i = 0; i < rest; ++i) below.row(i) = y.row(rows[i]);
    auto own = y.middleRows(fronts.first[run->front] + run->begin, columns);
    own.noalias() -= L.block(run->end, run->begin, rest, columns).transpose() * below;
    L.block(run->begin, run->begin, columns, columns).triangularView<Eigen::Lower>().transpose().solveInPlace(own);
  }
}

Eigen::VectorXd Condensation::recover(const Eigen::VectorXd& loads, const Eigen::VectorXd& kept) const {
  if (!factor_) return kept;
  // A response to what acts elsewhere has no loads in here.
  Eigen::VectorXd y = loads.isZero(0) ? Eigen::VectorXd(Eigen::VectorXd::Zero(size_)) : forward(loads);
  for (Eigen::Index k = 0; k < size_; ++k)
    if (is_kept(k)) y(k) = kept(row_at(k) - inner_);
  back_substitute(y);
  Eigen::VectorXd all(size_);
  for (Eigen::Index k = 0; k < size_; ++k) all(row_at(k)) = y(k);
  return all;
}

Eigen::MatrixXd Condensation::shapes() const {
  const Eigen::Index kept = size_ - inner_;
  if (!factor_) return Eigen::MatrixXd::Identity(kept, kept);
  if (kept == 0) return Eigen::MatrixXd(size_, kept);  // Eigen takes the address of a first column
  Eigen::MatrixXd y = Eigen::MatrixXd::Zero(size_, kept), all(size_, kept);
  for (Eigen::Index k = 0; k < size_; ++k)
    if (is_kept(k)) y(k, row_at(k) - inner_) = 1;
  back_substitute(y);
  for (Eigen::Index k = 0; k < size_; ++k) all.row(row_at(k)) = y.row(k);
  return all;
}

}  // namespace topple::solver
