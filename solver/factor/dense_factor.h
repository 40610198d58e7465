#pragma once
// L U of a small dense matrix that grows by a border of rows and columns, in storage that only grows: a correction gets
// a border with each break, and what was factorised before it stays. Pivots are sought inside of what was added
// together, so that the leading part keeps its factor.
#include <Eigen/Core>
#include <vector>

namespace topple::solver {

class DenseFactor {
 public:
  using Matrix = Eigen::Map<Eigen::MatrixXd, 0, Eigen::OuterStride<>>;

  /// Keeps the factor of a leading part, of `size` rows or fewer: whole borders, of a matrix that was far enough from
  /// singular to build on. Returns how many.
  int keep(int size);
  /// Makes room for size x size, at least what is kept, and returns it: the rows and columns behind what is kept are to
  /// be filled in (what they hold is undefined), the kept part is not to be touched.
  [[nodiscard]] Matrix grow(int size);
  /// Factorises what was filled in.
  void factorise();
  /// Estimates of the inverse's 1-norm (Hager, Higham; LAPACK's dgecon); infinite when the matrix is singular.
  [[nodiscard]] double inverse_norm() const { return inverse_norm_; }
  /// Number of the inverse's column with the largest 1-norm, by the same estimate; -1 when the matrix is singular.
  [[nodiscard]] int largest_inverse_column() const;
  /// x := A^-1 x, `columns` of them. Not for singular matrices.
  void solve(double* x, int columns = 1) const;
  [[nodiscard]] int size() const { return size_; }

  template <class Archive>
  void serialize(Archive& archive) {
    auto& [size, capacity, parts, value, work, pivot, integer_work, inverse_norm] = *this;  // both works are scratch
    archive(size, capacity, parts, pivot, inverse_norm);
    const auto room = static_cast<std::size_t>(capacity);
    value.resize(room * room);
    work.resize(4 * room);
    integer_work.resize(room);
    Matrix own(value.data(), size, size, Eigen::OuterStride<>(capacity));
    Eigen::MatrixXd leading = own;
    archive(leading);
    if constexpr (Archive::is_loading::value) own = leading;
  }

 private:
  [[nodiscard]] int kept() const;
  struct Part {
    int rows = 0;  ///< up to its end
    double inverse_norm = 1;
    template <class Archive>
    void serialize(Archive& archive) {
      auto& [up_to, of_inverse] = *this;
      archive(up_to, of_inverse);
    }
  };
  int size_ = 0, capacity_ = 0;
  std::vector<Part> parts_;  ///< added together, each
  std::vector<double> value_, work_;
  std::vector<int> pivot_, integer_work_;
  double inverse_norm_ = 1;
};

}  // namespace topple::solver
