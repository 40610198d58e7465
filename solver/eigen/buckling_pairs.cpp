#include "eigen/buckling_pairs.h"

#include <Eigen/Eigenvalues>
#include <array>
#include <cmath>
#include <limits>

#include "assembly/mass_matrix.h"

namespace topple::solver {
namespace {

constexpr int samples = 3;              // tangents between which V' T V is a parabola
constexpr double below_first = 0.8;     // linear estimates are too high: a pinned column of one member by 22 %
constexpr double past_estimate = 5e-3;  // of the shift behind the last estimate, relative
constexpr double equal = 1e-9;          // relative distance of factors that count as equal
constexpr double found = 1e-12;         // change of a factor, relative, that is none
constexpr int most_turns = 12, most_steps = 60;
constexpr double nothing_new = 1e-8;  // what is left of a vector beside the subspace when it is but rounding
constexpr double behind_last = 1e-6;  // of a count behind the last pair, where the shift lies before it

double largest_row_sum(const SparseSymmetric& A) {
  std::vector<double> sum(static_cast<std::size_t>(A.size), 0);
  for (std::size_t c = 0; c < sum.size(); ++c)
    for (auto k = static_cast<std::size_t>(A.start[c]); k < static_cast<std::size_t>(A.start[c + 1]); ++k) {
      const auto r = static_cast<std::size_t>(A.row[k]);
      sum[c] += std::abs(A.value[k]);
      if (r != c) sum[r] += std::abs(A.value[k]);
    }
  return sum.empty() ? 0 : *std::max_element(sum.begin(), sum.end());
}

Eigen::MatrixXd product(const SparseSymmetric& A, const Eigen::Ref<const Eigen::MatrixXd>& x) {
  Eigen::MatrixXd y = Eigen::MatrixXd::Zero(x.rows(), x.cols());
  multiply_symmetric(A, x, y);
  return y;
}

/// V and V' T V at the samples.
class SampledSubspace {
 public:
  SampledSubspace(const TangentOperators& operators, double low, double high) {
    for (int s = 0; s < samples; ++s) {
      place_[static_cast<std::size_t>(s)] = low + (high - low) * s / (samples - 1);
      tangent_[static_cast<std::size_t>(s)] = operators.tangent(place_[static_cast<std::size_t>(s)]);
    }
    row_sum_ = largest_row_sum(tangent_.front());
  }

  void add(const Eigen::MatrixXd& vectors) {
    const Eigen::Index before = V_.cols();
    V_.conservativeResize(vectors.rows(), before);
    for (Eigen::Index j = 0; j < vectors.cols(); ++j) {
      Eigen::VectorXd v = vectors.col(j);
      const double length = v.norm();
      if (!(length > 0)) continue;
      v /= length;
      for (int pass = 0; pass < 2; ++pass) v -= V_ * (V_.transpose() * v).eval();
      const double left = v.norm();
      if (!(left > nothing_new)) continue;
      V_.conservativeResize(vectors.rows(), V_.cols() + 1);
      V_.rightCols(1) = v / left;
    }
    const Eigen::Index added = V_.cols() - before;
    for (std::size_t s = 0; s < samples; ++s) {
      const Eigen::MatrixXd images = product(tangent_[s], V_.rightCols(added));
      projected_[s].conservativeResize(V_.cols(), V_.cols());
      projected_[s].rightCols(added) = V_.transpose() * images;
      projected_[s].bottomRows(added) = projected_[s].rightCols(added).transpose().eval();  // they share a corner
    }
  }

  [[nodiscard]] Eigen::Index columns() const { return V_.cols(); }
  /// Rounding of a quotient x' T x of a unit vector.
  [[nodiscard]] double rounding() const { return std::numeric_limits<double>::epsilon() * row_sum_; }

  /// Of the whole: eigenvectors of V' T V from the first-th smallest eigenvalue on.
  [[nodiscard]] Eigen::MatrixXd vectors(double factor, Eigen::Index first, Eigen::Index count) const {
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> dense(at_factor(factor, &SampledSubspace::weight));
    return V_ * dense.eigenvectors().middleCols(first, count);
  }

  struct Zero {
    double factor = 0, slope = 0;  ///< of the eigenvalue of V' T V that vanishes there
    Eigen::VectorXd vector;        ///< of the whole
    bool valid = false;
  };
  /// Where the k-th smallest eigenvalue (from 0) of V' T V vanishes.
  [[nodiscard]] Zero zero(Eigen::Index k, double start) const {
    Zero at{start, 0, {}, false};
    for (int step = 0; step < most_steps; ++step) {
      const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> dense(at_factor(at.factor, &SampledSubspace::weight));
      const Eigen::VectorXd y = dense.eigenvectors().col(k);
      at.slope = y.dot(at_factor(at.factor, &SampledSubspace::weight_slope) * y);
      if (!(at.slope < 0)) return at;
      const double move = -dense.eigenvalues()(k) / at.slope;
      at.factor += move;
      if (!(at.factor > 0) || !std::isfinite(at.factor)) return at;
      if (std::abs(move) > found / 10 * at.factor && std::abs(move * at.slope) > rounding()) continue;
      at.vector = V_ * y;
      at.valid = true;
      return at;
    }
    return at;
  }

 private:
  /// Lagrange's parabola through the samples.
  [[nodiscard]] double weight(std::size_t s, double factor) const {
    double product = 1;
    for (std::size_t t = 0; t < samples; ++t)
      if (t != s) product *= (factor - place_[t]) / (place_[s] - place_[t]);
    return product;
  }
  [[nodiscard]] double weight_slope(std::size_t s, double factor) const {
    double sum = 0, denominator = 1;
    for (std::size_t t = 0; t < samples; ++t) {
      if (t == s) continue;
      sum += factor - place_[t];
      denominator *= place_[s] - place_[t];
    }
    return sum / denominator;
  }
  [[nodiscard]] Eigen::MatrixXd at_factor(double factor,
                                          double (SampledSubspace::*of)(std::size_t, double) const) const {
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(columns(), columns());
    for (std::size_t s = 0; s < samples; ++s) sum += (this->*of)(s, factor) * projected_[s];
    return sum;
  }

  Eigen::MatrixXd V_;
  std::array<double, samples> place_{};
  std::array<SparseSymmetric, samples> tangent_;
  std::array<Eigen::MatrixXd, samples> projected_;
  double row_sum_ = 0;
};

class Search {
 public:
  Search(const TangentOperators& operators, const std::vector<BucklingStart>& starts, int count)
      : operators_(operators),
        count_(count),
        subspace_(operators, below_first * starts.front().factor,
                  (1 + past_estimate) * starts[static_cast<std::size_t>(count) - 1].factor) {
    Eigen::MatrixXd vectors(starts.front().vector.size(), static_cast<Eigen::Index>(starts.size()));
    for (std::size_t i = 0; i < starts.size(); ++i) vectors.col(static_cast<Eigen::Index>(i)) = starts[i].vector;
    subspace_.add(vectors);
    for (const BucklingStart& start : starts) guesses_.push_back(start.factor);
  }

  /// Empty when the lowest are not found, or not proved.
  std::vector<BucklingPair> run() {
    if (subspace_.columns() < count_ || !widen(count_)) return {};
    shift_ = (1 + past_estimate) * states_.back().projected.factor;
    below_shift_ = operators_.factorise(shift_);
    if (below_shift_ < 0) return {};
    // All that lie below the shift, where the subspace has them: its count is then the proof.
    (void)widen(below_shift_);
    for (;;) {
      if (!converge()) return {};
      const auto all = static_cast<int>(states_.size());
      const double last = states_.back().factor;
      const int below = below_shift_ == all && last <= shift_ ? all : operators_.count(last * (1 + behind_last));
      if (below == all) break;
      if (below < all || !widen(below)) return {};
    }
    return gather();
  }

 private:
  struct State {
    SampledSubspace::Zero projected;
    double factor = 0;  ///< where the exact tangent is looked at next
    Eigen::VectorXd vector;
    bool found = false;
  };

  /// Equal factors have their vectors from one and the same matrix: apart they would be any of a plane.
  [[nodiscard]] std::vector<BucklingPair> gather() const {
    std::vector<BucklingPair> pairs;
    for (std::size_t first = 0; first < states_.size();) {
      std::size_t end = first + 1;
      while (end < states_.size() && states_[end].factor <= states_[first].factor * (1 + equal)) ++end;
      const Eigen::MatrixXd together = subspace_.vectors(states_[first].factor, static_cast<Eigen::Index>(first),
                                                         static_cast<Eigen::Index>(end - first));
      for (std::size_t k = first; k < end; ++k)
        pairs.push_back({states_[k].factor, end - first == 1
                                                ? states_[k].vector
                                                : together.col(static_cast<Eigen::Index>(k - first)).eval()});
      first = end;
    }
    return pairs;
  }

  /// Takes in further pairs, up to so many; false where the subspace has not as many.
  bool widen(int count) {
    if (count > subspace_.columns() || count > static_cast<int>(guesses_.size())) return false;
    for (auto k = states_.size(); k < static_cast<std::size_t>(count); ++k) {
      State state;
      state.projected = subspace_.zero(static_cast<Eigen::Index>(k), guesses_[k]);
      if (!state.projected.valid) return false;
      state.factor = state.projected.factor;
      states_.push_back(std::move(state));
    }
    return true;
  }

  bool converge() {
    for (int turn = 0; turn < most_turns; ++turn) {
      Eigen::MatrixXd residuals(states_.front().projected.vector.size(), 0);
      std::vector<std::size_t> open;
      std::vector<double> moves;
      for (std::size_t k = 0; k < states_.size(); ++k) {
        State& state = states_[k];
        if (state.found) continue;
        const Eigen::VectorXd& x = state.projected.vector;
        const Eigen::VectorXd r = product(operators_.tangent(state.factor), x);
        moves.push_back(-x.dot(r) / state.projected.slope);
        residuals.conservativeResize(Eigen::NoChange, residuals.cols() + 1);
        residuals.rightCols(1) = r;
        open.push_back(k);
      }
      if (open.empty()) return true;
      if (!correct(residuals, open, moves)) return false;
    }
    return false;
  }

  /// What the residuals say: pairs that are found, and a wider subspace for the others.
  bool correct(const Eigen::MatrixXd& residuals, const std::vector<std::size_t>& open,
               const std::vector<double>& moves) {
    Eigen::MatrixXd corrections = residuals;
    operators_.solve(corrections);
    for (std::size_t i = 0; i < open.size(); ++i) {
      State& state = states_[open[i]];
      const auto column = static_cast<Eigen::Index>(i);
      // A vector that is off by e has a quotient that is off by e' T e: the residual's energy tells its size.
      const double doubt = std::abs(residuals.col(column).dot(corrections.col(column)) / state.projected.slope);
      const double least = std::max(found * state.factor, subspace_.rounding() / -state.projected.slope);
      if (!(state.factor + moves[i] > 0)) return false;
      state.found = std::abs(moves[i]) <= least && doubt <= least;
      state.factor += moves[i];
      state.vector = state.projected.vector;
    }
    subspace_.add(corrections);
    for (std::size_t k = 0; k < states_.size(); ++k) {
      State& state = states_[k];
      if (state.found) continue;
      const SampledSubspace::Zero zero = subspace_.zero(static_cast<Eigen::Index>(k), state.projected.factor);
      if (!zero.valid) return false;
      state.factor += zero.factor - state.projected.factor;
      state.projected = zero;
    }
    return true;
  }

  const TangentOperators& operators_;
  int count_;
  SampledSubspace subspace_;
  std::vector<double> guesses_;
  std::vector<State> states_;
  double shift_ = 0;
  int below_shift_ = 0;
};

}  // namespace

std::vector<BucklingPair> buckling_pairs(const TangentOperators& operators, const std::vector<BucklingStart>& starts,
                                         int count) {
  if (count < 1 || static_cast<int>(starts.size()) < count) return {};
  return Search(operators, starts, count).run();
}

}  // namespace topple::solver
