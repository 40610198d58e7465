#include "eigen/buckling_start.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "eigen/tall_products.h"

namespace topple::solver {
namespace {

constexpr Eigen::Index spare = 3, most_blocks = 12;  // width of a block beyond what is sought; how many of them
constexpr double settled_start = 2e-3;               // change of the estimates, relative, that ends the iteration
constexpr double nothing_left = 1e-10;  // what is left of a vector beside the others when it is but rounding

/// K-orthonormal vectors V with K V and G V.
class Basis {
 public:
  Basis(const LinearisedBuckling& operators, Eigen::Index capacity) : op_(operators) {
    for (Eigen::MatrixXd* m : {&V_, &KV_, &GV_}) m->resize(op_.size, capacity);
  }

  /// Takes in K^-1 times these columns, as far as they bring anything new; returns how many did.
  Eigen::Index add(const Eigen::MatrixXd& forces) {
    const Eigen::Index before = columns_;
    Eigen::MatrixXd moved = forces, Kmoved = forces;
    op_.solve(moved);
    const Eigen::VectorXd energy = moved.cwiseProduct(Kmoved).colwise().sum();
    for (int pass = 0; pass < 2; ++pass) {
      const Eigen::MatrixXd along = tall_product(KV_.leftCols(before), moved, op_.threads);
      subtract_tall(V_.leftCols(before), along, moved, op_.threads);
      subtract_tall(KV_.leftCols(before), along, Kmoved, op_.threads);
    }
    for (Eigen::Index j = 0; j < forces.cols() && columns_ < V_.cols(); ++j) {
      if (!(energy(j) > 0)) continue;
      Eigen::VectorXd v = moved.col(j), Kv = Kmoved.col(j);
      for (int pass = 0; pass < 2; ++pass) {
        const Eigen::VectorXd along = KV_.middleCols(before, columns_ - before).transpose() * v;
        v -= V_.middleCols(before, columns_ - before) * along;
        Kv -= KV_.middleCols(before, columns_ - before) * along;
      }
      const double left = v.dot(Kv);
      if (!(left > nothing_left * energy(j))) continue;
      V_.col(columns_) = v / std::sqrt(left);
      KV_.col(columns_++) = Kv / std::sqrt(left);
    }
    GV_.middleCols(before, columns_ - before) = op_.multiply(V_.middleCols(before, columns_ - before));
    return columns_ - before;
  }

  [[nodiscard]] Eigen::MatrixXd last_forces(Eigen::Index count) const {
    return GV_.middleCols(columns_ - count, count);
  }

  /// The lowest factors, at most `count`.
  [[nodiscard]] std::vector<double> factors(int count) const {
    std::vector<double> found;
    const Eigen::VectorXd largest_first = ritz().eigenvalues().reverse();
    for (const double value : largest_first)
      if (value > 0 && static_cast<int>(found.size()) < count) found.push_back(1 / value);
    return found;
  }

  [[nodiscard]] std::vector<BucklingStart> starts(int count) const {
    if (columns_ == 0) return {};
    const auto dense = ritz();
    std::vector<BucklingStart> found;
    for (Eigen::Index i = columns_; i-- > 0 && static_cast<int>(found.size()) < count;) {
      const double value = dense.eigenvalues()(i);
      if (!(value > 0)) break;
      found.push_back({1 / value, V_.leftCols(columns_) * dense.eigenvectors().col(i)});
    }
    return found;
  }

 private:
  [[nodiscard]] Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> ritz() const {
    const Eigen::MatrixXd H = tall_product(V_.leftCols(columns_), GV_.leftCols(columns_), op_.threads);
    return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(0.5 * (H + H.transpose()));
  }

  const LinearisedBuckling& op_;
  Eigen::MatrixXd V_, KV_, GV_;
  Eigen::Index columns_ = 0;
};

bool settled_between(const std::vector<double>& before, const std::vector<double>& now, int count) {
  if (static_cast<int>(before.size()) < count || now.size() != before.size()) return false;
  for (std::size_t i = 0; i < now.size(); ++i)
    if (std::abs(now[i] - before[i]) > settled_start * now[i]) return false;
  return true;
}

}  // namespace

std::vector<BucklingStart> estimate_buckling(const LinearisedBuckling& operators, int count) {
  const Eigen::Index width = std::min<Eigen::Index>(operators.size, count + spare);
  if (width == 0) return {};
  Basis basis(operators, std::min<Eigen::Index>(operators.size, most_blocks * width));
  // Vectors without any symmetry of their own.
  Eigen::MatrixXd start(operators.size, width);
  for (Eigen::Index j = 0; j < width; ++j)
    for (Eigen::Index i = 0; i < operators.size; ++i)
      start(i, j) = std::sin(1.0 + 0.7 * static_cast<double>(i) + 1.3 * static_cast<double>(j * i % 977));
  Eigen::Index added = basis.add(operators.multiply(start));
  std::vector<double> before;
  for (Eigen::Index b = 1; b < most_blocks && added > 0; ++b) {
    added = basis.add(basis.last_forces(added));
    std::vector<double> now = basis.factors(count);
    if (settled_between(before, now, count)) break;
    before = std::move(now);
  }
  return basis.starts(count);
}

}  // namespace topple::solver
