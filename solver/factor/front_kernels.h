#pragma once
// The arithmetic of dense elimination on strips: 24 rows of a matrix, packed column by column, so that a strip serves
// as the left and as the right factor of a product. 24 rows by 8 columns of sums fill the registers of AVX-512.
//
// Every entry is summed by itself, in order of depth, with fused multiply-adds: its bits depend neither on the tile in
// which it lies nor on the width of the processor's vectors. (Processors without fused multiply-adds round twice.)
#include <cstddef>
#include <cstdint>

namespace topple::solver {

inline constexpr int strip_rows = 24, strip_columns = 8;

/// Rows that lie side by side in two fronts.
struct RowRun {
  std::int32_t from, to, count;
};

struct FrontKernels {
  const char* name;
  /// C -= A B'. A: a strip of `depth` columns; B: eight rows of another one, from its `b`-th entry on; C: the leading
  /// rows (at most 24) and columns (at most 8) of an array with `stride` between columns. In C, nothing else is
  /// touched.
  void (*subtract_product)(const double* a, const double* b, int depth, double* c, std::ptrdiff_t stride, int rows,
                           int columns);
  /// C := -A B', the same otherwise.
  void (*negative_product)(const double* a, const double* b, int depth, double* c, std::ptrdiff_t stride, int rows,
                           int columns);
  /// X := X T^-T, X being `columns` (at most 8) columns of a strip. T is a lower triangle with the stride of a strip;
  /// `inverse` holds the inverses of its diagonal.
  void (*solve_triangle)(double* x, const double* triangle, const double* inverse, int columns);
  /// to[run.to - skip + i] += from[run.from + start + i] for all runs.
  void (*add_runs)(double* to, std::ptrdiff_t skip, const double* from, std::ptrdiff_t start, const RowRun* runs,
                   int count);
};

/// The best that this processor has.
[[nodiscard]] const FrontKernels& front_kernels();
/// Plain loops, for every processor; and the others, null where the processor or the compiler lacks them.
[[nodiscard]] const FrontKernels& plain_front_kernels();
[[nodiscard]] const FrontKernels* avx2_front_kernels();
[[nodiscard]] const FrontKernels* avx512_front_kernels();

}  // namespace topple::solver
