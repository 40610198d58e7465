#include "factor/front_kernels.h"

#include <cmath>

namespace topple::solver {
namespace {

double multiply_add(double a, double b, double c) {
#ifdef __FP_FAST_FMA
  return std::fma(a, b, c);
#else
  return a * b + c;
#endif
}

template <bool subtract>
void product(const double* a, const double* b, int depth, double* c, std::ptrdiff_t stride, int rows, int columns) {
  double sum[strip_columns][strip_rows] = {};
  for (int k = 0; k < depth; ++k, a += strip_rows, b += strip_rows)
    for (int j = 0; j < columns; ++j)
      for (int i = 0; i < strip_rows; ++i) sum[j][i] = multiply_add(a[i], b[j], sum[j][i]);
  for (int j = 0; j < columns; ++j)
    for (int i = 0; i < rows; ++i) c[j * stride + i] = subtract ? c[j * stride + i] - sum[j][i] : -sum[j][i];
}

void solve_triangle(double* x, const double* triangle, const double* inverse, int columns) {
  for (int j = 0; j < columns; ++j) {
    double* own = x + j * strip_rows;
    for (int i = 0; i < strip_rows; ++i) own[i] *= inverse[j];
    for (int c = j + 1; c < columns; ++c)
      for (int i = 0; i < strip_rows; ++i)
        x[c * strip_rows + i] = multiply_add(-own[i], triangle[j * strip_rows + c], x[c * strip_rows + i]);
  }
}

void add_runs(double* to, std::ptrdiff_t skip, const double* from, std::ptrdiff_t start, const RowRun* runs,
              int count) {
  for (const RowRun* run = runs; run != runs + count; ++run)
    for (int i = 0; i < run->count; ++i) to[run->to - skip + i] += from[run->from + start + i];
}

}  // namespace

const FrontKernels& plain_front_kernels() {
  static constexpr FrontKernels kernels{"plain", product<true>, product<false>, solve_triangle, add_runs};
  return kernels;
}

const FrontKernels& front_kernels() {
  if (const FrontKernels* kernels = avx512_front_kernels()) return *kernels;
  if (const FrontKernels* kernels = avx2_front_kernels()) return *kernels;
  return plain_front_kernels();
}

}  // namespace topple::solver
