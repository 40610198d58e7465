#include "factor/front_kernels.h"

#if defined(__x86_64__) && defined(__GNUC__)
#include <immintrin.h>

#define TOPPLE_AVX2 __attribute__((target("avx2,fma")))
#define TOPPLE_UNROLL _Pragma("GCC unroll 24")

namespace topple::solver {
namespace {

constexpr int lanes = 4, part_rows = 12, part_columns = 4, vectors = part_rows / lanes;

/// 12 rows and 4 columns of the product: as many sums as 16 registers hold.
TOPPLE_AVX2 void product_part(const double* a, const double* b, int depth, double* product) {
  __m256d sum[part_columns][vectors];
  TOPPLE_UNROLL for (int j = 0; j < part_columns; ++j) TOPPLE_UNROLL for (int v = 0; v < vectors; ++v) sum[j][v] =
      _mm256_setzero_pd();
  for (int k = 0; k < depth; ++k, a += strip_rows, b += strip_rows) {
    __m256d x[vectors];
    TOPPLE_UNROLL for (int v = 0; v < vectors; ++v) x[v] = _mm256_loadu_pd(a + v * lanes);
    TOPPLE_UNROLL for (int j = 0; j < part_columns; ++j) {
      const __m256d y = _mm256_broadcast_sd(b + j);
      TOPPLE_UNROLL for (int v = 0; v < vectors; ++v) sum[j][v] = _mm256_fmadd_pd(x[v], y, sum[j][v]);
    }
  }
  TOPPLE_UNROLL for (int j = 0; j < part_columns; ++j) TOPPLE_UNROLL for (int v = 0; v < vectors; ++v)
      _mm256_storeu_pd(product + j * strip_rows + v * lanes, sum[j][v]);
}

template <bool subtract>
TOPPLE_AVX2 void product(const double* a, const double* b, int depth, double* c, std::ptrdiff_t stride, int rows,
                         int columns) {
  double part[strip_columns * strip_rows];
  for (int j = 0; j < columns; j += part_columns)
    for (int i = 0; i < rows; i += part_rows) product_part(a + i, b + j, depth, part + j * strip_rows + i);
  for (int j = 0; j < columns; ++j) {
    double* to = c + j * stride;
    const double* from = part + j * strip_rows;
    int i = 0;
    for (; i + lanes <= rows; i += lanes)
      _mm256_storeu_pd(
          to + i, _mm256_sub_pd(subtract ? _mm256_loadu_pd(to + i) : _mm256_set1_pd(-0.0), _mm256_loadu_pd(from + i)));
    for (; i < rows; ++i) to[i] = subtract ? to[i] - from[i] : -from[i];
  }
}

TOPPLE_AVX2 void solve_triangle(double* x, const double* triangle, const double* inverse, int columns) {
  for (int j = 0; j < columns; ++j) {
    double* own = x + j * strip_rows;
    const __m256d factor = _mm256_broadcast_sd(inverse + j);
    for (int i = 0; i < strip_rows; i += lanes)
      _mm256_storeu_pd(own + i, _mm256_mul_pd(_mm256_loadu_pd(own + i), factor));
    for (int c = j + 1; c < columns; ++c) {
      const __m256d l = _mm256_broadcast_sd(triangle + j * strip_rows + c);
      double* other = x + c * strip_rows;
      for (int i = 0; i < strip_rows; i += lanes)
        _mm256_storeu_pd(other + i, _mm256_fnmadd_pd(_mm256_loadu_pd(own + i), l, _mm256_loadu_pd(other + i)));
    }
  }
}

TOPPLE_AVX2 void add_runs(double* to, std::ptrdiff_t skip, const double* from, std::ptrdiff_t start, const RowRun* runs,
                          int count) {
  for (const RowRun* run = runs; run != runs + count; ++run) {
    double* target = to + (run->to - skip);
    const double* source = from + (run->from + start);
    int i = 0;
    for (; i + lanes <= run->count; i += lanes)
      _mm256_storeu_pd(target + i, _mm256_add_pd(_mm256_loadu_pd(target + i), _mm256_loadu_pd(source + i)));
    for (; i < run->count; ++i) target[i] += source[i];
  }
}

}  // namespace

const FrontKernels* avx2_front_kernels() {
  static constexpr FrontKernels kernels{"AVX2", product<true>, product<false>, solve_triangle, add_runs};
  __builtin_cpu_init();
  return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") ? &kernels : nullptr;
}

}  // namespace topple::solver

#else

namespace topple::solver {
const FrontKernels* avx2_front_kernels() { return nullptr; }
}  // namespace topple::solver

#endif
