#include "factor/front_kernels.h"

#if defined(__x86_64__) && defined(__GNUC__)
#include <immintrin.h>

#define TOPPLE_AVX512 __attribute__((target("avx512f")))
#define TOPPLE_UNROLL _Pragma("GCC unroll 24")

namespace topple::solver {
namespace {

constexpr int lanes = 8;

/// V vectors of rows.
template <int V, bool subtract>
TOPPLE_AVX512 void product_of_rows(const double* a, const double* b, int depth, double* c, std::ptrdiff_t stride,
                                   int rows, int columns) {
  __m512d sum[strip_columns][V];
  TOPPLE_UNROLL for (int j = 0; j < strip_columns; ++j) {
    TOPPLE_UNROLL for (int v = 0; v < V; ++v) sum[j][v] = _mm512_setzero_pd();
    if (j < columns) {
      TOPPLE_UNROLL for (int v = 0; v < V; ++v) _mm_prefetch(c + j * stride + v * lanes, _MM_HINT_T0);
    }
  }
  for (int k = 0; k < depth; ++k, a += strip_rows, b += strip_rows) {
    __m512d x[V];
    TOPPLE_UNROLL for (int v = 0; v < V; ++v) x[v] = _mm512_loadu_pd(a + v * lanes);
    TOPPLE_UNROLL for (int j = 0; j < strip_columns; ++j) {
      const __m512d y = _mm512_set1_pd(b[j]);
      TOPPLE_UNROLL for (int v = 0; v < V; ++v) sum[j][v] = _mm512_fmadd_pd(x[v], y, sum[j][v]);
    }
  }
  const auto last = static_cast<__mmask8>((1U << (rows - (V - 1) * lanes)) - 1);
  TOPPLE_UNROLL for (int j = 0; j < strip_columns; ++j) {
    if (j >= columns) continue;
    double* to = c + j * stride;
    TOPPLE_UNROLL for (int v = 0; v < V; ++v) {
      const __mmask8 mask = v < V - 1 ? static_cast<__mmask8>(0xff) : last;
      // Minus zero minus a sum is the sum's negative, to the sign of zero.
      const __m512d before = subtract ? _mm512_maskz_loadu_pd(mask, to + v * lanes) : _mm512_set1_pd(-0.0);
      _mm512_mask_storeu_pd(to + v * lanes, mask, _mm512_sub_pd(before, sum[j][v]));
    }
  }
}

template <bool subtract>
void product(const double* a, const double* b, int depth, double* c, std::ptrdiff_t stride, int rows, int columns) {
  if (rows > 2 * lanes) return product_of_rows<3, subtract>(a, b, depth, c, stride, rows, columns);
  if (rows > lanes) return product_of_rows<2, subtract>(a, b, depth, c, stride, rows, columns);
  product_of_rows<1, subtract>(a, b, depth, c, stride, rows, columns);
}

template <int N>
TOPPLE_AVX512 void solve_columns(double* x, const double* triangle, const double* inverse) {
  constexpr int V = strip_rows / lanes;
  __m512d column[N][V];
  TOPPLE_UNROLL for (int j = 0; j < N; ++j) TOPPLE_UNROLL for (int v = 0; v < V; ++v) column[j][v] =
      _mm512_loadu_pd(x + j * strip_rows + v * lanes);
  TOPPLE_UNROLL for (int j = 0; j < N; ++j) {
    const __m512d factor = _mm512_set1_pd(inverse[j]);
    TOPPLE_UNROLL for (int v = 0; v < V; ++v) column[j][v] = _mm512_mul_pd(column[j][v], factor);
    TOPPLE_UNROLL for (int c = j + 1; c < N; ++c) {
      const __m512d l = _mm512_set1_pd(triangle[j * strip_rows + c]);
      TOPPLE_UNROLL for (int v = 0; v < V; ++v) column[c][v] = _mm512_fnmadd_pd(column[j][v], l, column[c][v]);
    }
  }
  TOPPLE_UNROLL for (int j = 0; j < N; ++j) TOPPLE_UNROLL for (int v = 0; v < V; ++v)
      _mm512_storeu_pd(x + j * strip_rows + v * lanes, column[j][v]);
}

void solve_triangle(double* x, const double* triangle, const double* inverse, int columns) {
  using Solve = void (*)(double*, const double*, const double*);
  static constexpr Solve solve[strip_columns] = {solve_columns<1>, solve_columns<2>, solve_columns<3>,
                                                 solve_columns<4>, solve_columns<5>, solve_columns<6>,
                                                 solve_columns<7>, solve_columns<8>};
  solve[columns - 1](x, triangle, inverse);
}

TOPPLE_AVX512 void add_runs(double* to, std::ptrdiff_t skip, const double* from, std::ptrdiff_t start,
                            const RowRun* runs, int count) {
  for (const RowRun* run = runs; run != runs + count; ++run) {
    double* target = to + (run->to - skip);
    const double* source = from + (run->from + start);
    int i = 0;
    for (; i + lanes <= run->count; i += lanes)
      _mm512_storeu_pd(target + i, _mm512_add_pd(_mm512_loadu_pd(target + i), _mm512_loadu_pd(source + i)));
    if (i == run->count) continue;
    const auto rest = static_cast<__mmask8>((1U << (run->count - i)) - 1);
    _mm512_mask_storeu_pd(
        target + i, rest,
        _mm512_add_pd(_mm512_maskz_loadu_pd(rest, target + i), _mm512_maskz_loadu_pd(rest, source + i)));
  }
}

}  // namespace

const FrontKernels* avx512_front_kernels() {
  static constexpr FrontKernels kernels{"AVX-512", product<true>, product<false>, solve_triangle, add_runs};
  __builtin_cpu_init();
  return __builtin_cpu_supports("avx512f") ? &kernels : nullptr;
}

}  // namespace topple::solver

#else

namespace topple::solver {
const FrontKernels* avx512_front_kernels() { return nullptr; }
}  // namespace topple::solver

#endif
