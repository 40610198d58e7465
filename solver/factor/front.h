#pragma once
// Partial Cholesky factorisation (or, with signs, L S L') of a dense front: its leading columns are eliminated, the
// rest receives their update.
#include <cstddef>
#include <memory>
#include <vector>

namespace topple::solver {

class TaskTeam;

/// Where the lower triangle of an update of `size` rows lies: columns go by strips of 24, each strip's columns as long
/// as its first one. Half the memory of a square.
class UpdateLayout {
 public:
  explicit UpdateLayout(int size) : size_(size) {}
  /// Place of entry (0, column), which is not stored, relative to the first; rows follow each other.
  [[nodiscard]] std::ptrdiff_t column(int column) const;
  [[nodiscard]] std::ptrdiff_t stride(int column) const;  ///< to the next column of the same strip
  [[nodiscard]] std::size_t entries() const;

 private:
  std::ptrdiff_t size_;
};

/// A symmetric front of `rows` rows, of which the first `pivots` are eliminated. Lower triangles, column by column;
/// what lies above them is not meaningful, but must be finite.
struct Front {
  int rows = 0, pivots = 0;
  double* panel = nullptr;   ///< rows x pivots: becomes L
  double* update = nullptr;  ///< UpdateLayout(below()): need not be set; becomes what this front adds to those above
  [[nodiscard]] int below() const { return rows - pivots; }
};

/// Memory for the strips of one front at a time; grows only.
class FrontWorkspace {
 public:
  double* reserve(std::size_t entries);

 private:
  struct Free {
    void operator()(double* p) const;
  };
  std::unique_ptr<double, Free> memory_;
  std::size_t size_ = 0;
};

/// Columns of a front whose pivots are negative, ascending.
using NegativePivots = std::vector<int>;

/// Returns how many columns have been eliminated: all `pivots`, or the index of the first whose pivot is not positive.
/// With `negative` (L S L', S of signs, as a count of eigenvalues needs it) only what is not finite ends it, and those
/// columns are added to the list. `team` (unless null) has its idle threads help; the result is the same to the bit.
[[nodiscard]] int eliminate(const Front& front, FrontWorkspace& workspace, TaskTeam* team,
                            NegativePivots* negative = nullptr);

}  // namespace topple::solver
