#include "factor/panel_substitution.h"

#include <algorithm>
#include <cstddef>
#include <type_traits>

#include "factor/vector_versions.h"

namespace topple::solver {
namespace {

constexpr int panel_strip = 8, strip_rows = 8, most_together = 4;

/// Of the eight parts of a sum.
[[gnu::always_inline]] inline double total(const double* p) {
  return ((p[0] + p[4]) + (p[2] + p[6])) + ((p[1] + p[5]) + (p[3] + p[7]));
}

/// Adds the products of fewer than eight rows to the parts of their sums.
template <class Lanes, int K, int N>
[[gnu::always_inline]] inline void add_tail(const double* L, std::ptrdiff_t ld, const double* b, std::ptrdiff_t stride,
                                            double* parts) {
  for (int k = 0; k < K; ++k)
    for (int c = 0; c < N; ++c)
      lanes_at<Lanes>(parts + (k * N + c) * strip_rows) +=
          lanes_at<Lanes>(L + k * ld) * lanes_at<Lanes>(b + c * stride);
}

/// Columns at a time of a whole strip, with N right-hand sides: as many as leave registers for the sums.
template <class Eight, int N>
inline constexpr int most_columns = std::is_same_v<Eight, EightLanes> ? (N <= 2 ? 8 : 4)
                                                                      : (N == 1   ? 4
                                                                         : N == 2 ? 2
                                                                                  : 1);

/// sum[k * N + c] := the product of column k of L and column c of b, k < K, c < N.
template <class Eight, int K, int N>
[[gnu::always_inline]] inline void multiply_columns(const double* L, std::ptrdiff_t ld, const double* b,
                                                    std::ptrdiff_t stride, int rows, double* sum) {
  typename Eight::Vector part[K * N] = {};
  int i = 0;
  for (; i + strip_rows <= rows; i += strip_rows)
    each_constant<K * N>([&](auto p) __attribute__((always_inline)) {
      part[p] += lanes_at<Eight>(L + p / N * ld + i) * lanes_at<Eight>(b + p % N * stride + i);
    });
  double parts[K * N * strip_rows];
  each_constant<K * N>([&](auto p)
                           __attribute__((always_inline)) { lanes_at<Eight>(parts + p * strip_rows) = part[p]; });
  if (rows - i >= FourLanes::count) {
    add_tail<FourLanes, K, N>(L + i, ld, b + i, stride, parts);
    i += FourLanes::count;
  }
  const int after_four = i % strip_rows;
  if (rows - i >= TwoLanes::count) {
    add_tail<TwoLanes, K, N>(L + i, ld, b + i, stride, parts + after_four);
    i += TwoLanes::count;
  }
  if (i < rows) add_tail<OneLane, K, N>(L + i, ld, b + i, stride, parts + i % strip_rows);
  for (int p = 0; p < K * N; ++p) sum[p] = total(parts + p * strip_rows);
}

/// sum[k * N + c] of `width` (at most 8) columns of L; as many at a time as leave registers for the sums.
template <class Eight, int N>
[[gnu::always_inline]] inline void products(const double* L, std::ptrdiff_t ld, int width, const double* b,
                                            std::ptrdiff_t stride, int rows, double* sum) {
  if (width == panel_strip) {
    constexpr int group = most_columns<Eight, N>;
    for (int k = 0; k < panel_strip; k += group)
      multiply_columns<Eight, group, N>(L + k * ld, ld, b, stride, rows, sum + k * N);
    return;
  }
  int k = 0;
  if (width >= 4) {
    multiply_columns<Eight, 4, N>(L, ld, b, stride, rows, sum);
    k = 4;
  }
  if (width - k >= 2) {
    multiply_columns<Eight, 2, N>(L + k * ld, ld, b, stride, rows, sum + k * N);
    k += 2;
  }
  if (k < width) multiply_columns<Eight, 1, N>(L + k * ld, ld, b, stride, rows, sum + k * N);
}

using Products = void (*)(const double*, std::ptrdiff_t, int, const double*, std::ptrdiff_t, int, double*);
#define TOPPLE_PRODUCTS(N)                                                                             \
  TOPPLE_EIGHT_LANES(void products_##N(const double* L, std::ptrdiff_t ld, int width, const double* b, \
                                       std::ptrdiff_t stride, int rows, double* sum),                  \
                     products<Eight, N>(L, ld, width, b, stride, rows, sum);)
TOPPLE_PRODUCTS(1)
TOPPLE_PRODUCTS(2)
TOPPLE_PRODUCTS(3)
TOPPLE_PRODUCTS(4)
#undef TOPPLE_PRODUCTS
constexpr Products products_of[most_together] = {products_1, products_2, products_3, products_4};

/// x -= L' b for `width` (at most 8) columns of L.
void subtract_products(const double* L, std::ptrdiff_t ld, int width, const double* b, std::ptrdiff_t stride, int rows,
                       double* x, std::ptrdiff_t x_stride, int count) {
  if (rows <= 0) return;
  double sum[panel_strip * most_together];
  products_of[count - 1](L, ld, width, b, stride, rows, sum);
  for (int c = 0; c < count; ++c)
    for (int k = 0; k < width; ++k) x[c * x_stride + k] -= sum[k * count + c];
}

/// x := T^-T x for `width` columns of a lower triangle.
void substitute_triangle(const double* T, std::ptrdiff_t ld, int width, double* x) {
  for (int k = width; k-- > 0;) {
    const double value = x[k] *= 1 / T[k * ld + k];
    for (int j = 0; j < k; ++j) x[j] -= T[j * ld + k] * value;
  }
}

/// One strip of columns of L, at most four right-hand sides.
void substitute(const double* L, int columns, int rows, int first, double* x, int count, const double* below) {
  const int below_rows = rows - columns, width = std::min(panel_strip, columns - first), next = first + width;
  const double* block = L + static_cast<std::ptrdiff_t>(first) * rows;
  subtract_products(block + columns, rows, width, below, below_rows, below_rows, x + first, columns, count);
  subtract_products(block + next, rows, width, x + next, columns, columns - next, x + first, columns, count);
  for (int c = 0; c < count; ++c)
    substitute_triangle(block + first, rows, width, x + static_cast<std::ptrdiff_t>(c) * columns + first);
}

}  // namespace

void substitute_back(const double* L, int columns, int rows, double* x, int count, const double* below) {
  // Strip by strip for all right-hand sides: a strip stays in the cache, the panel comes from memory once.
  for (int first = (columns - 1) / panel_strip * panel_strip; first >= 0; first -= panel_strip)
    for (int c = 0; c < count; c += most_together)
      substitute(L, columns, rows, first, x + static_cast<std::ptrdiff_t>(c) * columns,
                 std::min(most_together, count - c), below + static_cast<std::ptrdiff_t>(c) * (rows - columns));
}

}  // namespace topple::solver
