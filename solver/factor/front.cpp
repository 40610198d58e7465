#include "factor/front.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <new>
#include <vector>

#include "factor/front_kernels.h"
#include "parallel/task_team.h"

namespace topple::solver {
namespace {

/// Columns that are eliminated together: their strips fill most of the first-level cache, and what lies behind them is
/// read and written once for so many.
constexpr int block_columns = 144;
/// Strips on a side of the tiles into which the update is cut, and in a chunk of the strips that are solved for.
constexpr int tile_strips = 10, chunk_strips = 4;
constexpr std::size_t alignment = 64;

/// One block of columns [from, from + width) of a front, and all rows from there on. Strips do not reach over the
/// boundary between the panel and the update.
class BlockElimination {
 public:
  BlockElimination(const Front& front, int from, int width, double* packed, NegativePivots* negative)
      : kernels_(front_kernels()),
        front_(front),
        negative_(negative),
        from_(from),
        width_(width),
        panel_strips_(strips_of(front.pivots - from)),
        strips_(panel_strips_ + strips_of(front.below())),
        own_strips_(strips_of(width)),
        stride_(static_cast<std::ptrdiff_t>(width) * strip_rows),
        packed_(packed) {}

  static int strips_of(int rows) { return (rows + strip_rows - 1) / strip_rows; }

  /// Factorises the triangle; returns the columns done.
  int factorise_triangle() {
    for (int s = 0; s < own_strips_; ++s) {
      pack(s);
      const int done = eliminate_strip(s);
      if (done < width_ && done < (s + 1) * strip_rows) return done;
      unpack(s);
    }
    return width_;
  }

  [[nodiscard]] int chunks() const { return (strips_ - own_strips_ + chunk_strips - 1) / chunk_strips; }
  void solve_chunk(int chunk) {
    const int first = own_strips_ + chunk * chunk_strips;
    for (int s = first; s < std::min(first + chunk_strips, strips_); ++s) {
      pack(s);
      eliminate_strip(s);
      unpack(s);
    }
  }

  [[nodiscard]] int tiles() const {
    const int side = tile_rows();
    return side * (side + 1) / 2;
  }
  void update_tile(int tile) const {
    int row = 0;
    while (tile > row) tile -= ++row;
    const int first_row = own_strips_ + row * tile_strips, first_column = own_strips_ + tile * tile_strips;
    const int end_row = std::min(first_row + tile_strips, strips_);
    for (int s = first_row; s < end_row; ++s)
      for (int t = first_column; t < std::min(first_column + tile_strips, s + 1); ++t) update(s, t);
  }

 private:
  [[nodiscard]] int tile_rows() const { return (strips_ - own_strips_ + tile_strips - 1) / tile_strips; }
  [[nodiscard]] int first_row(int s) const {
    return s < panel_strips_ ? from_ + s * strip_rows : front_.pivots + (s - panel_strips_) * strip_rows;
  }
  [[nodiscard]] int rows(int s) const {
    return std::min(strip_rows, (s < panel_strips_ ? front_.pivots : front_.rows) - first_row(s));
  }
  [[nodiscard]] double* strip(int s) const { return packed_ + s * stride_; }
  [[nodiscard]] double* panel(int row, int column) const {
    return front_.panel + static_cast<std::ptrdiff_t>(column) * front_.rows + row;
  }

  void pack(int s) const {
    const int count = rows(s), row = first_row(s);
    double* to = strip(s);
    for (int c = 0; c < width_; ++c, to += strip_rows) {
      const double* from = panel(row, from_ + c);
      if (count == strip_rows) {
        std::memcpy(to, from, strip_rows * sizeof(double));  // of a fixed length: a few moves, no call
        continue;
      }
      for (int i = 0; i < count; ++i) to[i] = from[i];
      for (int i = count; i < strip_rows; ++i) to[i] = 0;
    }
  }

  void unpack(int s) const {
    const int count = rows(s), row = first_row(s);
    const double* from = strip(s);
    for (int c = 0; c < width_; ++c, from += strip_rows) {
      double* to = panel(row, from_ + c);
      if (s >= own_strips_ && count == strip_rows) {
        std::memcpy(to, from, strip_rows * sizeof(double));
        continue;
      }
      // Above the diagonal nothing is kept.
      for (int i = s < own_strips_ ? std::max(c - s * strip_rows, 0) : 0; i < count; ++i) to[i] = from[i];
    }
  }

  /// The strip's columns from left to right: what those before them contribute, then the triangle on the diagonal.
  /// Returns the columns done (a strip of the triangle ends at its own last one).
  int eliminate_strip(int s) {
    const int end = s < own_strips_ ? std::min(width_, (s + 1) * strip_rows) : width_;
    double* own = strip(s);
    for (int c = 0; c < end; c += strip_columns) {
      const int columns = std::min(strip_columns, end - c), q = c / strip_rows, r = c % strip_rows;
      double* x = own + static_cast<std::ptrdiff_t>(c) * strip_rows;
      const double* other = strip(q);
      if (c > 0) {
        kernels_.subtract_product(own, other + r, c, x, strip_rows, strip_rows, columns);
        correct_signs(own, other + r, c, x, strip_rows, strip_rows, columns);
      }
      if (q == s) {
        const int done = factorise_diagonal(x + r, columns, c);
        if (done < columns) return c + done;
        std::copy(x + r, x + r + diagonal_entries(columns), diagonal_);
      }
      const double* triangle = other + static_cast<std::ptrdiff_t>(c) * strip_rows + r;
      if (q == s) {
        solve_below_diagonal(x, r, columns, c);
      } else {
        solve_triangle(x, triangle, c, columns);
      }
    }
    return end;
  }

  /// What a product takes with the wrong sign: a negative pivot's columns add where the others subtract.
  void correct_signs(const double* a, const double* b, int depth, double* to, std::ptrdiff_t stride, int rows,
                     int columns) const {
    for (const int k : own_negative_) {
      if (k >= depth) return;
      const double *left = a + static_cast<std::ptrdiff_t>(k) * strip_rows,
                   *right = b + static_cast<std::ptrdiff_t>(k) * strip_rows;
      for (int j = 0; j < columns; ++j)
        for (int i = 0; i < rows; ++i) to[j * stride + i] += 2 * left[i] * right[j];
    }
  }

  /// X := X T^-T of the columns from c on, S being among the signs: X (S T')^-1.
  void solve_triangle(double* x, const double* triangle, int c, int columns) const {
    const auto first = std::lower_bound(own_negative_.begin(), own_negative_.end(), c);
    if (first == own_negative_.end() || *first >= c + columns)
      return kernels_.solve_triangle(x, triangle, inverse_ + c, columns);
    double with_signs[strip_columns * strip_rows];
    std::copy(triangle, triangle + diagonal_entries(columns), with_signs);
    for (auto k = first; k != own_negative_.end() && *k < c + columns; ++k)
      for (int i = *k - c; i < columns; ++i) with_signs[(*k - c) * strip_rows + i] *= -1;
    kernels_.solve_triangle(x, with_signs, inverse_ + c, columns);
  }

  static std::ptrdiff_t diagonal_entries(int columns) { return (columns - 1) * strip_rows + columns; }

  /// Rows of the diagonal's own strip: its triangle lies among them, and is put back afterwards.
  void solve_below_diagonal(double* x, int r, int columns, int c) {
    solve_triangle(x, diagonal_, c, columns);
    for (int j = 0; j < columns; ++j) {
      double* column = x + j * strip_rows;
      std::fill(column, column + r + j, 0.0);
      std::copy(diagonal_ + j * strip_rows + j, diagonal_ + j * strip_rows + columns, column + r + j);
    }
  }

  /// Plain Cholesky of at most eight columns, from the block's `first`-th on; returns those done.
  int factorise_diagonal(double* x, int columns, int first) {
    double* inverse = inverse_ + first;
    for (int j = 0; j < columns; ++j) {
      double* own = x + j * strip_rows;
      const double sign = judge_pivot(own[j], first + j);
      if (sign == 0) return j;
      own[j] = std::sqrt(sign * own[j]);
      inverse[j] = sign / own[j];
      for (int i = j + 1; i < columns; ++i) own[i] *= inverse[j];
      for (int c = j + 1; c < columns; ++c)
        for (int i = c; i < columns; ++i) x[c * strip_rows + i] -= own[i] * (sign * own[c]);
    }
    return columns;
  }

  /// The pivot's sign; 0 where the elimination ends.
  double judge_pivot(double& pivot, int column) {
    if (!std::isfinite(pivot)) return 0;
    if (pivot > 0) return 1;
    if (negative_ == nullptr) return 0;
    // One that is exactly zero stands for a shift that hits an eigenvalue of a part: it counts as positive.
    if (pivot == 0) {
      pivot = std::numeric_limits<double>::epsilon();
      return 1;
    }
    own_negative_.push_back(column);
    negative_->push_back(from_ + column);
    return -1;
  }

  /// Strip s of the rows, strip t of the columns, behind the block.
  void update(int s, int t) const {
    const int column = first_row(t), columns = rows(t), row = first_row(s), count = rows(s);
    const bool in_panel = t < panel_strips_;
    const UpdateLayout layout(front_.below());
    const int behind = column - front_.pivots;
    const std::ptrdiff_t stride = in_panel ? front_.rows : layout.stride(behind);
    double* to = in_panel ? panel(row, column) : front_.update + (layout.column(behind) + row - front_.pivots);
    // The first block sets the update, the others go on from there.
    const auto product = in_panel || from_ > 0 ? kernels_.subtract_product : kernels_.negative_product;
    for (int c = 0; c < columns; c += strip_columns) {
      const int together = std::min(strip_columns, columns - c);
      product(strip(s), strip(t) + c, width_, to + c * stride, stride, count, together);
      correct_signs(strip(s), strip(t) + c, width_, to + c * stride, stride, count, together);
    }
  }

  const FrontKernels& kernels_;
  const Front& front_;
  NegativePivots* negative_;
  std::vector<int> own_negative_;  ///< columns of this block, ascending
  int from_, width_, panel_strips_, strips_, own_strips_;
  std::ptrdiff_t stride_;
  double* packed_;
  double inverse_[block_columns];
  double diagonal_[strip_columns * strip_rows];
};

}  // namespace

std::ptrdiff_t UpdateLayout::column(int column) const {
  const std::ptrdiff_t strip = column / strip_rows, first = strip * strip_rows;
  // The strips before it: 24 columns of size, size - 24, size - 48, ... rows.
  const std::ptrdiff_t before = strip_rows * (strip * size_ - strip_rows * (strip * (strip - 1) / 2));
  return before + (column - first) * (size_ - first) - first;
}

std::ptrdiff_t UpdateLayout::stride(int column) const { return size_ - column / strip_rows * strip_rows; }

std::size_t UpdateLayout::entries() const {
  if (size_ == 0) return 0;
  const int last = static_cast<int>(size_) - 1;
  return static_cast<std::size_t>(column(last) + size_);
}

void FrontWorkspace::Free::operator()(double* p) const { ::operator delete (p, std::align_val_t{alignment}); }

double* FrontWorkspace::reserve(std::size_t entries) {
  if (entries > size_) {
    memory_.reset();
    size_ = 0;
    memory_.reset(static_cast<double*>(::operator new (entries * sizeof(double), std::align_val_t{alignment})));
    size_ = entries;
  }
  return memory_.get();
}

int eliminate(const Front& front, FrontWorkspace& workspace, TaskTeam* team, NegativePivots* negative) {
  const auto each = [&](int count, auto&& work) {
    if (team != nullptr) {
      team->split(count, work);
    } else {
      for (int i = 0; i < count; ++i) work(i);
    }
  };
  const int widest = std::min(block_columns, front.pivots);
  const int most_strips = BlockElimination::strips_of(front.pivots) + BlockElimination::strips_of(front.below());
  double* packed =
      workspace.reserve(static_cast<std::size_t>(most_strips) * strip_rows * static_cast<std::size_t>(widest));
  for (int from = 0; from < front.pivots; from += block_columns) {
    BlockElimination block(front, from, std::min(block_columns, front.pivots - from), packed, negative);
    const int done = block.factorise_triangle();
    if (done < std::min(block_columns, front.pivots - from)) return from + done;
    each(block.chunks(), [&](int chunk) { block.solve_chunk(chunk); });
    each(block.tiles(), [&](int tile) { block.update_tile(tile); });
  }
  return front.pivots;
}

}  // namespace topple::solver
