#pragma once
// Static condensation of a sparse symmetric matrix to its last rows (R. J. Guyan, AIAA Journal 3 (1965), 380), by the
// multifrontal factor: with the kept rows eliminated last, what they receive from the inner ones is their Schur
// complement, and the couplings stay as sparse as the factor is.
//
//   K = [Kii Kik]   S = Kkk - Kki Kii^-1 Kik
//       [Kki Kkk]
//
// So that the kept part is positive definite even where S is not (a patch that is free in space), its diagonal counts
// twice in the factor, and once less in S.
#include <Eigen/Core>
#include <optional>
#include <vector>

#include "assembly/sparse.h"
#include "factor/multifrontal.h"

namespace topple::solver {

class Condensation {
 public:
  /// Rows from `inner` on are kept; the pattern couples all of them. `order`: the inner rows in the order of
  /// elimination, then the kept ones in any. Throws std::invalid_argument for another.
  Condensation(const SparseSymmetric& pattern, int inner, const std::vector<int>& order);

  /// Of a matrix with that pattern. False when its inner part is not positive definite.
  [[nodiscard]] bool factorise(SparseSymmetric matrix);
  /// Of the kept rows, in their order in the matrix.
  [[nodiscard]] const Eigen::MatrixXd& schur() const { return schur_; }

  /// Loads on the kept rows alone that do what these loads on all rows do: fk - Kki Kii^-1 fi.
  [[nodiscard]] Eigen::VectorXd condense(const Eigen::VectorXd& loads) const;
  /// All unknowns, those of the kept rows being `kept`: ui = Kii^-1 (fi - Kik uk).
  [[nodiscard]] Eigen::VectorXd recover(const Eigen::VectorXd& loads, const Eigen::VectorXd& kept) const;
  /// All unknowns without loads, a column for a unit of each kept row.
  [[nodiscard]] Eigen::MatrixXd shapes() const;

 private:
  /// Columns of one front that stand together and are inner ones.
  struct Run {
    std::size_t front;
    Eigen::Index begin, end;
  };
  [[nodiscard]] Eigen::VectorXd forward(const Eigen::VectorXd& loads) const;
  /// From the kept rows on, in the order of elimination; a column for each case.
  template <class Columns>
  void back_substitute(Columns& y) const;
  /// The row of the matrix that is eliminated k-th.
  [[nodiscard]] Eigen::Index row_at(std::int64_t k) const {
    return static_cast<Eigen::Index>(factor_->fronts().order[static_cast<std::size_t>(k)]);
  }
  [[nodiscard]] bool is_kept(std::int64_t k) const { return row_at(k) >= inner_; }
  [[nodiscard]] Eigen::MatrixXd kept_columns() const;

  Eigen::Index inner_, size_;
  std::vector<Run> runs_;                     ///< in the order of elimination
  std::optional<MultifrontalFactor> factor_;  ///< none when there is no row
  Eigen::MatrixXd schur_;
};

}  // namespace topple::solver
