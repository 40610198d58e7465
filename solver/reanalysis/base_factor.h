#pragma once
// A factor that is used while the structure changes. It keeps the low-rank correction from what the system was when the
// factor was made to what it is now, and predicts what the correction costs. Parts that left bear no load and get no
// displacement.
#include <Eigen/Core>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "factor/factor.h"
#include "factor/triangular.h"
#include "reanalysis/low_rank.h"
#include "reanalysis/system_changes.h"
#include "reanalysis/update_costs.h"

namespace topple::solver {

class BaseFactor {
 public:
  /// Records changes from now on. The factor of the system's matrix, as it is now, may be given later. The system must
  /// outlive this.
  explicit BaseFactor(const FrameSystem& system);
  /// Takes the factor, which must outlive this. plan() and solve() need it.
  void install(const Factor& factor);
  /// The same with the triangles over that factor, made elsewhere.
  void install(TriangularSolver triangles);
  /// Adds at most so many of the changes since the factor was made to its correction: a part of the work, beside each
  /// answer of the older factor.
  struct CaughtUp {
    bool all = true;  ///< nothing is left, or what is left only a new factor takes
    double operations = 0;
  };
  [[nodiscard]] CaughtUp catch_up(int places);

  /// To be told of every change of the system.
  [[nodiscard]] SystemChanges& changes() { return changes_; }

  /// Compares the system as it is now with what it was.
  struct Plan {
    bool possible = false;  ///< false: the change is of a kind that only a new factor takes
    int rank = 0;           ///< columns of the correction
    double operations = 0;  ///< to bring it up to date and for one answer
    CorrectionWork work;    ///< the same by kind, as ways are compared by
  };
  [[nodiscard]] Plan plan();
  /// Carries the last plan out.
  void update();
  /// The same, and eliminates a right-hand side, zero outside of `rows`, together with the new places: the blocks of
  /// the factor are read once for both. forward_along() and solve_along() use it.
  void update(std::span<const int> rows, const Eigen::VectorXd& right_hand_side);

  /// x := K^-1 x of the matrix as it stands. `rows` (unless null): x is zero in all other rows.
  void solve(Eigen::VectorXd& x, const std::vector<int>* rows = nullptr) const;
  /// The same for several columns, zero outside of `rows` all of them, the factor gone through once.
  void solve(Eigen::MatrixXd& X, const std::vector<int>& rows) const;
  /// The same on the elimination paths of `rows` alone, where X may differ from zero: a part of the work. `known` (per
  /// row) tells where X holds the answer; it is zero elsewhere.
  void solve_on_paths(Eigen::MatrixXd& X, const std::vector<int>& rows, std::vector<char>& known) const;
  /// The same up to the backward solve: y, in elimination order, of which L^-T makes the answer. Rows as above, the
  /// blocks on their paths in `marked`.
  void forward(const Eigen::VectorXd& x, const std::vector<char>& marked, Eigen::VectorXd& y) const;
  /// As forward() and solve(), of the right-hand side that update() eliminated.
  void forward_along(Eigen::VectorXd& y) const;
  void solve_along(Eigen::VectorXd& x) const;
  /// A beam that will be taken away, and a right-hand side for the matrix without it: zero outside of these rows,
  /// those of the beam's nodes.
  struct Loss {
    int beam;
    std::vector<int> rows;
    Eigen::VectorXd residual;
  };
  /// The answers to all of them, a column each (zero where the matrix without the beam is singular), the factor gone
  /// through together. Only while nothing differs from when it was made; the corrections are kept for what follows.
  [[nodiscard]] Eigen::MatrixXd solve_without(std::span<const Loss> losses);
  [[nodiscard]] const TriangularSolver& triangles() const { return *solver_; }
  /// The softest motion of the changed structure relative to that of the factor (scaled equations), and by what factor
  /// it is softer than there.
  [[nodiscard]] Eigen::VectorXd softest_motion() const;
  [[nodiscard]] double softening() const { return correction_->softening(); }
  /// Whether anything differs from when the factor was made.
  [[nodiscard]] bool changed() const { return correction_->active_rank() > 0 || changes_.any_dropped(); }
  [[nodiscard]] int rank() const { return correction_->active_rank(); }
  /// Operations of one answer.
  [[nodiscard]] double solve_operations() const;
  /// Predicted cost (update_costs.h) of the factor's own part of one answer, and of its correction.
  [[nodiscard]] double solve_cost() const;
  [[nodiscard]] double correction_cost() const;

  /// Of one that is to be loaded the factor is installed before, where it was.
  template <class Archive>
  void serialize(Archive& archive) {
    // The system and the factor are their owner's. What follows `planned` lives no longer than an answer.
    auto& [system, changes, solver, correction, number, planned, along, eliminated, column, columns, marked] = *this;
    archive(changes, number, planned);
    if (correction) archive(*correction);
  }

 private:
  void forget_unchanged(std::optional<Eigen::Index> kept = {});
  void add_planned();
  void apply_changes();
  void finish_solve(Eigen::VectorXd& x) const;
  void eliminate(const Eigen::MatrixXd& X, const std::vector<int>& rows) const;
  void restore(Eigen::MatrixXd& X) const;

  const FrameSystem& system_;
  SystemChanges changes_;
  std::optional<TriangularSolver> solver_;
  std::optional<LowRankCorrection> correction_;
  std::map<SystemChanges::Place, int> number_;            ///< of the correction's places
  std::map<SystemChanges::Place, ElementModes> planned_;  ///< of places that the last plan adds
  Eigen::VectorXd along_;                                 ///< in elimination order
  mutable Eigen::VectorXd eliminated_, column_;
  mutable Eigen::MatrixXd columns_;
  mutable std::vector<char> marked_;
};

}  // namespace topple::solver
