#include "eigen/block_krylov.h"

#include <Eigen/Eigenvalues>
#include <cstdint>

#include "eigen/tall_products.h"

namespace topple::solver {
namespace {

constexpr int blocks = 3;
constexpr double negligible = 1e-11;   // what is left of a vector beside the subspace when it is but rounding
constexpr double cancelled = 1e-4;     // the same when differences of M v have lost digits
constexpr double vanishing = 1e-13;    // eigenvalues below this share of the largest are rounding of zero
constexpr double small_enough = 1e-9;  // relative residual: eigenvalues are right to its square

/// The same numbers on every machine.
Eigen::MatrixXd arbitrary(Eigen::Index rows, Eigen::Index columns) {
  Eigen::MatrixXd x(rows, columns);
  std::uint64_t state = 0x9E3779B97F4A7C15ULL;
  for (Eigen::Index j = 0; j < columns; ++j)
    for (Eigen::Index i = 0; i < rows; ++i) {
      state = state * 6364136223846793005ULL + 1442695040888963407ULL;
      x(i, j) = static_cast<double>(state >> 11) / 9007199254740992.0 - 0.5;
    }
  return x;
}

class Subspace {
 public:
  explicit Subspace(const KrylovOperators& operators, Eigen::Index capacity) : op_(operators) {
    for (Eigen::MatrixXd* m : {&V_, &MV_, &W_}) m->resize(op_.size, capacity);
  }

  void clear() { columns_ = 0; }
  [[nodiscard]] Eigen::Index columns() const { return columns_; }

  /// Takes in what a block adds, M-orthonormal; returns how many columns that is.
  Eigen::Index add(Eigen::MatrixXd block) {
    const Eigen::Index before = columns_;
    Eigen::MatrixXd M = op_.multiply(block);
    const Eigen::VectorXd lengths = block.cwiseProduct(M).colwise().sum().cwiseMax(0).cwiseSqrt();
    for (int pass = 0; pass < 2 && before > 0; ++pass)
      subtract_tall(V_.leftCols(before), tall_product(MV_.leftCols(before), block, op_.threads), block, op_.threads);
    if (before > 0) M = op_.multiply(block);
    for (Eigen::Index j = 0; j < block.cols() && columns_ < V_.cols(); ++j) {
      Eigen::VectorXd v = block.col(j), Mv = M.col(j);
      const double length = lengths(j);
      if (!(length > 0)) continue;
      for (int pass = 0; pass < 2; ++pass) {
        const Eigen::Index own = columns_ - before;
        const Eigen::VectorXd along = MV_.middleCols(before, own).transpose() * v;
        v -= V_.middleCols(before, own) * along;
        Mv -= MV_.middleCols(before, own) * along;
      }
      double left = std::sqrt(std::max(v.dot(Mv), 0.0));
      if (left < cancelled * length) {
        Mv = op_.multiply(v);
        left = std::sqrt(std::max(v.dot(Mv), 0.0));
      }
      if (!(left > negligible * length)) continue;
      V_.col(columns_) = v / left;
      MV_.col(columns_++) = Mv / left;
    }
    if (columns_ > before) {
      W_.middleCols(before, columns_ - before) = MV_.middleCols(before, columns_ - before);
      op_.solve(W_.middleCols(before, columns_ - before));
    }
    return columns_ - before;
  }

  /// A times the last `count` columns.
  [[nodiscard]] Eigen::MatrixXd images(Eigen::Index count) const { return W_.middleCols(columns_ - count, count); }

  struct Ritz {
    Eigen::VectorXd values, residuals;  ///< residuals relative, in the M norm
    Eigen::MatrixXd vectors, images;    ///< images: A times the vectors
  };
  [[nodiscard]] Ritz ritz(Eigen::Index wanted) const {
    const Eigen::MatrixXd H = tall_product(MV_.leftCols(columns_), W_.leftCols(columns_), op_.threads);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> dense(0.5 * (H + H.transpose()));
    const Eigen::VectorXd all = dense.eigenvalues().reverse();
    Eigen::Index n = 0;
    while (n < std::min(wanted, columns_) && all(n) > vanishing * all(0)) ++n;
    const Eigen::MatrixXd Y = dense.eigenvectors().rowwise().reverse().leftCols(n);
    Ritz found{all.head(n), Eigen::VectorXd(n), V_.leftCols(columns_) * Y, W_.leftCols(columns_) * Y};
    const Eigen::MatrixXd r = found.images - found.vectors * found.values.asDiagonal(), Mr = op_.multiply(r);
    for (Eigen::Index j = 0; j < n; ++j)
      found.residuals(j) = std::sqrt(std::max(r.col(j).dot(Mr.col(j)), 0.0)) / found.values(j);
    return found;
  }

 private:
  const KrylovOperators& op_;
  Eigen::MatrixXd V_, MV_, W_;
  Eigen::Index columns_ = 0;
};

}  // namespace

KrylovAnswer largest_eigenvalues(const KrylovOperators& operators, int count, int extra, int restarts) {
  const Eigen::Index width = std::min<Eigen::Index>(operators.size, count + extra);
  Subspace subspace(operators, std::min<Eigen::Index>(operators.size, blocks * width));
  Eigen::MatrixXd X = operators.multiply(arbitrary(operators.size, width));
  operators.solve(X);
  double worst = 0;
  for (int restart = 0; restart < restarts; ++restart) {
    subspace.clear();
    Eigen::Index added = subspace.add(X);
    for (int b = 1; b < blocks && added > 0; ++b) added = subspace.add(subspace.images(added));
    if (subspace.columns() == 0) return {{}, {}, 0, true, 0, true};
    // Saturated: the last block brought nothing new, so the subspace is invariant.
    const bool invariant = added == 0 || subspace.columns() == operators.size;
    Subspace::Ritz found = subspace.ritz(invariant ? subspace.columns() : width);
    const Eigen::Index known = found.values.size();
    KrylovAnswer answer;
    while (answer.converged < known && found.residuals(answer.converged) <= small_enough) ++answer.converged;
    answer.complete = invariant && known < width;
    const Eigen::Index needed = std::min<Eigen::Index>(count, known);
    worst = needed > 0 ? found.residuals.head(needed).maxCoeff() : 0;
    if (answer.converged >= needed && (known >= count || invariant)) {
      answer.values = found.values;
      answer.vectors = found.images * found.values.cwiseInverse().asDiagonal();
      answer.residual = worst;
      return answer;
    }
    X = found.images.leftCols(std::min(known, width));
  }
  KrylovAnswer unsettled;
  unsettled.residual = worst;
  unsettled.settled = false;
  return unsettled;
}

}  // namespace topple::solver
