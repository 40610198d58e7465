#pragma once
// The factor in use, with what changed since it was made as a low-rank correction, and the choice between a
// correction and a new factor. All vectors are in the scaled equations unless they are called forces or displacements.
#include <Eigen/Core>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "assembly/frame_system.h"
#include "assembly/matrix_rows.h"
#include "assembly/mechanism.h"
#include "assembly/refinement.h"
#include "factor/factor.h"
#include "reanalysis/base_factor.h"
#include "reanalysis/factor_refresh.h"
#include "reanalysis/reanalysis_work.h"
#include "reanalysis/update_costs.h"

namespace topple::solver {

class ServingFactor {
 public:
  /// Without a factor. Both must outlive this.
  ServingFactor(const FrameSystem& system, const AnalysisOptions& options) : system_(system), options_(options) {}
  ServingFactor(const ServingFactor&) = delete;
  ServingFactor& operator=(const ServingFactor&) = delete;

  /// A new factor of the matrix as it is, judged.
  [[nodiscard]] Stability make(ReanalysisWork& work);
  /// Another one in its place, corrections included. Returns what served before.
  [[nodiscard]] FactorRefresh::Made replace(FactorRefresh::Made made);
  /// There is a change that only a new factor takes.
  void forget_base() { base_.reset(); }

  /// Null while there is no factor, or one that is not corrected: its matrix lies in the warning band.
  [[nodiscard]] BaseFactor* base() const { return base_.get(); }
  [[nodiscard]] const FrameSystem& system() const { return system_; }
  /// Of the matrix; there since the first factor.
  [[nodiscard]] MatrixRows& rows() const { return *rows_; }
  [[nodiscard]] const std::vector<int>& order() const { return order_; }
  /// Anything differs from when the factor was made.
  [[nodiscard]] bool corrected() const { return base_ && base_->changed(); }
  /// Of the matrix as it stands: the factor's, times what it has softened by.
  [[nodiscard]] double condition() const;
  /// It became so much softer than when the factor was made that its correction loses digits.
  [[nodiscard]] bool is_soft() const;

  /// How the changes since the last correction are taken over.
  struct Choice {
    bool correction = false;           ///< false: by a new factor, which is cheaper, or all that can decide
    bool last_alone_too_much = false;  ///< what changed last is more than a correction takes, whatever came before
    BaseFactor::Plan plan;             ///< of the correction
  };
  [[nodiscard]] Choice choose(const RefreshRules& rules);
  /// After the correction was brought up to date: takes the softest motion into the verdict. False: it cannot decide.
  [[nodiscard]] bool judge_correction(Stability& verdict);

  /// Predicted, of a new factor with all that comes with it.
  [[nodiscard]] double cost() const { return predicted_cost(factor_work()); }
  /// Operations of a new factor with the estimate of its condition.
  [[nodiscard]] double operations() const;
  /// What answers cost beyond those of a new factor is borne until it comes to as much as that (to rent or to buy).
  [[nodiscard]] bool worn() const { return correction_paid_ > cost(); }
  /// An answer was found, `solves` times over the factor and its correction. Returns what that cost.
  double count_answer(int solves);

  [[nodiscard]] LinearSolve linear_solve() const;
  /// x := K^-1 x of the matrix as it stands, without a look at its error; refined once where the structure is_soft().
  /// Returns what that cost, as count_answer().
  double solve(Eigen::VectorXd& x);
  /// Refines x until its error is within the limit.
  [[nodiscard]] Eigen::VectorXd refine_to(double limit, const Eigen::VectorXd& right_hand_side, Eigen::VectorXd x,
                                          double& error) const;
  /// Displacements (not scaled) under forces that are zero in most equations, a column each, the factor gone through
  /// once for all of them; refined to response_error.
  [[nodiscard]] Eigen::MatrixXd respond(const Eigen::MatrixXd& force, std::vector<double>& errors) const;
  /// The same on the elimination paths of what is loaded, and of these nodes (BaseFactor::solve_on_paths()); not
  /// refined.
  [[nodiscard]] Eigen::MatrixXd respond_on_paths(const Eigen::MatrixXd& force, std::span<const int> nodes,
                                                 std::vector<char>& known) const;

  // factor_archive.h. Factors are not written, but what they were made of: they have the same bits when made anew.
  template <class Archive>
  void save(Archive& archive) const;
  template <class Archive>
  void load(Archive& archive);

 private:
  [[nodiscard]] FactorWork factor_work() const;
  [[nodiscard]] Eigen::VectorXd respond_alone(const Eigen::VectorXd& force, double& error) const;
  [[nodiscard]] std::vector<int> scale_columns(const Eigen::MatrixXd& force, Eigen::MatrixXd& scaled) const;

  const FrameSystem& system_;
  const AnalysisOptions& options_;
  std::vector<int> order_;  ///< of elimination
  std::unique_ptr<Factor> factor_;
  std::vector<double> values_;  ///< of the matrix that it was made of
  std::unique_ptr<MatrixRows> rows_;
  std::unique_ptr<BaseFactor> base_;
  double condition_ = 0;            ///< of the factorised matrix
  double correction_paid_ = 0;      ///< predicted cost of changes from before, since the factor was made
  double looked_at_softening_ = 0;  ///< at which the softest motion was looked at last
  Eigen::VectorXd left_over_;       ///< scratch of solve()
};

}  // namespace topple::solver
