#pragma once
// Exact answers of a changed matrix over a base factor: K + B D B', K = L L' (in elimination order). With W = L^-1
// B,
//   (K + B D B')^-1 = L^-T (I - W (I + D G)^-1 D W') L^-1,   G = W'W
// (Woodbury, in the form that takes a singular D). One backward solve serves an answer; W is nonzero on the elimination
// path of what changed alone, and made there. I + D G is similar to a symmetric matrix whose eigenvalues are the
// stationary values of v'(K + B D B')v / v'Kv: it is singular exactly when the changed structure is a mechanism, and
// the inverse of its least eigenvalue is what the condition has grown by.
#include <Eigen/Core>
#include <span>
#include <vector>

#include "factor/dense_factor.h"
#include "factor/triangular.h"

namespace topple::solver {

class LowRankCorrection {
 public:
  /// `solver` must outlive it.
  explicit LowRankCorrection(const TriangularSolver& solver) : solver_(solver) {}

  /// A place that may change: the rows of the matrix (an element's: they lie on one elimination path; one may come
  /// twice) and B there, one row each. Returns its number; its D is zero.
  int add(std::span<const int> rows, const Eigen::MatrixXd& B);
  /// Finds W of all places added since the last call, together; L^-1 of `also` and of y (as TriangularSolver::forward()
  /// has it) in the same pass. To be called before set() of any of them.
  void finish_adding(std::span<const PathColumns> also = {}, Eigen::VectorXd* y = nullptr,
                     const std::vector<char>* marked = nullptr);
  /// Replaces the place's D (symmetric; zero: unchanged).
  void set(int place, const Eigen::Ref<const Eigen::MatrixXd>& D);
  /// Forgets places whose D is zero when they have become the greater part, and have more than `kept` columns. Returns
  /// for each place so far its new number, -1 when forgotten; empty when nothing was.
  [[nodiscard]] std::vector<int> forget_unchanged(Eigen::Index kept = always_kept);
  /// What correct() would do to a y that is zero outside of the place's path, if this place alone had a D, and this
  /// one. False: the changed structure is a mechanism.
  [[nodiscard]] bool correct_alone(int place, const Eigen::Ref<const Eigen::MatrixXd>& D,
                                   Eigen::VectorXd& on_path) const;
  [[nodiscard]] const EliminationPath& path(int place) const { return places_[static_cast<std::size_t>(place)].path; }
  /// Brings the correction up to date with all D. To be called before what follows.
  void update();

  /// Columns of all places with a D, of all places.
  [[nodiscard]] int active_rank() const { return active_rank_; }
  [[nodiscard]] int rank() const { return static_cast<int>(gram_size_); }
  /// Columns of the active places before this one, which need no work when it changes; all columns when it is not one.
  [[nodiscard]] int rank_before(int place) const;
  [[nodiscard]] int place_count() const { return static_cast<int>(places_.size()); }
  /// Norm of the inverse of I + D G: how much the change has softened the structure in its softest motion.
  [[nodiscard]] double softening() const { return softening_; }
  /// Rows of all W of the active places: what one correct() goes through.
  [[nodiscard]] double entries() const;

  /// y (= L^-1 f) := y - W (I + D G)^-1 D W'y; L^-T of it is the answer.
  void correct(Eigen::VectorXd& y) const;
  /// L v of the softest motion v, scaled to 1, as seen from the change that takes most part in it; in elimination
  /// order.
  [[nodiscard]] Eigen::VectorXd softest_motion() const;

  // factor_archive.h
  template <class Archive>
  void save(Archive& archive) const;
  template <class Archive>
  void load(Archive& archive);

 private:
  /// Columns; to break and restore the same few joints makes nothing anew.
  static constexpr Eigen::Index always_kept = 96;
  struct Place {
    EliminationPath path;
    Eigen::MatrixXd W;  ///< orthonormal columns on the path
    Eigen::MatrixXd R;  ///< L^-1 B = W R
    Eigen::MatrixXd D;  ///< R (the given D) R'
    int first = 0;      ///< its first row in gram_
    bool active = false;
    bool factorised = false;       ///< with this D
    std::vector<char> gram_known;  ///< per place up to itself: whether gram_ has their product
    template <class Archive>
    void serialize(Archive& archive) {
      auto& [along, columns, triangle, change, row, is_active, is_factorised, known] = *this;
      archive(along, columns, triangle, change, row, is_active, is_factorised, known);
    }
  };
  /// Calls visit(place, other) for each product that gram_ has.
  template <class Visit>
  void each_known_product(const Visit& visit) const;
  int order_active();
  void fill_capacitance(int kept);
  void compute_gram(Place& place, const Place& other);
  /// c := W' y of the active places, and y -= W c.
  void gather(const Eigen::VectorXd& y, Eigen::Ref<Eigen::VectorXd> c) const;
  void subtract(const Eigen::Ref<const Eigen::VectorXd>& c, Eigen::VectorXd& y) const;

  const TriangularSolver& solver_;
  std::vector<Place> places_;
  Eigen::MatrixXd gram_;  ///< W'W of pairs of places that were active together
  Eigen::Index gram_size_ = 0;
  std::size_t finished_ = 0;  ///< places before this one have their W
  std::vector<int> active_;   ///< places with a D, in the capacitance's order: what changed last comes last
  int active_rank_ = 0;
  DenseFactor capacitance_;
  double softening_ = 1;
  // Scratch; grows only.
  mutable std::vector<double> coefficients_, product_;
};

}  // namespace topple::solver
