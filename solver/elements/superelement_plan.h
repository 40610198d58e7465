#pragma once
// What stays as it is of a superelement while shells go, and what its copies share: the patch, the stiffness of each
// shell in the numbers of the equations, their pattern, and the order in which inner ones are eliminated.
#include <array>
#include <cstdint>
#include <vector>

#include "assembly/sparse.h"
#include "elements/shell.h"
#include "topple/solver/superelement.h"

namespace topple::solver {

struct Superelement::Plan {
 public:
  /// Throws std::invalid_argument for shells or nodes that are none.
  explicit Plan(Superelement::Patch patch);

  /// A freedom of a node as seen by the equations: up to two numbers with weights. Inner ones count from 0, kept ones
  /// from `inner`; held ones have none.
  struct Seen {
    std::array<int, 2> number{-1, -1};
    std::array<double, 2> weight{0, 0};
  };
  /// One shell in the numbers of the equations: ties are worked in.
  struct Element {
    std::vector<int> number;          ///< ascending
    Eigen::MatrixXd stiffness;        ///< whole
    std::vector<std::int64_t> place;  ///< of its lower triangle by columns, in the matrix
  };

  [[nodiscard]] const Superelement::Patch& patch() const { return patch_; }
  [[nodiscard]] const Seen& seen(int node, int component) const {
    return freedoms_[static_cast<std::size_t>(6 * node + component)];
  }
  /// Equations that are condensed, and all of them.
  [[nodiscard]] int inner() const { return inner_; }
  [[nodiscard]] int size() const { return inner_ + 6 * static_cast<int>(patch_.kept.size()); }
  /// As long as all shells stand: what goes later leaves equations without stiffness behind, so that pattern, order and
  /// fronts stay.
  [[nodiscard]] const std::vector<Element>& elements() const { return elements_; }
  /// Lower triangle with all that the elements couple, the kept rows among themselves included; values 0.
  [[nodiscard]] const SparseSymmetric& pattern() const { return pattern_; }
  /// Stiffness of a shell, whole, in the freedoms of its nodes.
  [[nodiscard]] const Mat24& own(std::size_t shell) const { return own_[shell]; }
  /// Inner nodes by nested dissection. Then the kept ones, the last first: as blocks of their own, so that a front near
  /// one of them does not take all of them along.
  [[nodiscard]] std::vector<int> order_of_elimination() const;

 private:
  static SparseSymmetric pattern_of(const std::vector<Element>& elements, int inner, int size);
  static void find_places(const SparseSymmetric& pattern, Element& element);
  void number_freedoms();
  [[nodiscard]] Element element_of(std::size_t shell) const;

  Superelement::Patch patch_;
  std::vector<Mat24> own_;
  std::vector<Seen> freedoms_;  ///< per node and component
  int inner_ = 0;
  std::vector<Element> elements_;
  SparseSymmetric pattern_;
};

}  // namespace topple::solver
