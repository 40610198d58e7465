#include "factor/multiple_right_hand_sides.h"

#include <algorithm>
#include <cstddef>
#include <type_traits>

#include "factor/vector_versions.h"

namespace topple::solver {
namespace {

constexpr int strip = 8;                           // columns of L at a time
constexpr int six = 6;                             // right-hand sides at a time
constexpr std::ptrdiff_t panel_in_cache = 100000;  // entries

/// Numbers of one row of coefficients: N of them count, the others are zero.
template <class Eight, int N>
using RowLanes = std::conditional_t<N == 1, OneLane, Eight>;

/// target(i, c) += sum over k < width of L(i, k) coefficient(k, c), for N columns of the target.
template <class Eight, int N>
[[gnu::always_inline]] inline void add_columns(const double* L, std::ptrdiff_t ld, int width, const double* coefficient,
                                               double* target, std::ptrdiff_t stride, int rows) {
  each_lanes<Eight>(
      rows, [&]([[maybe_unused]] auto lanes, int i) __attribute__((always_inline)) {
        using Lanes = decltype(lanes);
        typename Lanes::Vector sum[N];
        each_constant<N>([&](auto c)
                             __attribute__((always_inline)) { sum[c] = lanes_at<Lanes>(target + c * stride + i); });
        for (int k = 0; k < width; ++k) {
          const typename Lanes::Vector l = lanes_at<Lanes>(L + k * ld + i);
          each_constant<N>([&](auto c) __attribute__((always_inline)) {
            sum[c] += l * coefficient[k * RowLanes<Eight, N>::count + c];
          });
        }
        each_constant<N>([&](auto c)
                             __attribute__((always_inline)) { lanes_at<Lanes>(target + c * stride + i) = sum[c]; });
      });
}

/// x := T^-1 x, a row of x after the other; T is a lower triangle of `strip` columns.
template <class Row>
[[gnu::always_inline]] inline void solve_strip(const double* T, std::ptrdiff_t ld, double* x) {
  typename Row::Vector row[strip];
  each_constant<strip>([&](auto k) __attribute__((always_inline)) { row[k] = lanes_at<Row>(x + k * Row::count); });
  each_constant<strip>([&](auto k) __attribute__((always_inline)) {
    row[k] = row[k] * (1 / T[k * ld + k]);
    each_constant<strip - 1 - k>([&](auto after) __attribute__((always_inline)) {
      constexpr int i = k + 1 + after;
      row[i] -= T[k * ld + i] * row[k];
    });
    lanes_at<Row>(x + k * Row::count) = row[k];
  });
}

/// The same for fewer columns.
template <class Row>
[[gnu::always_inline]] inline void solve_narrow_strip(const double* T, std::ptrdiff_t ld, int width, double* x) {
  for (int k = 0; k < width; ++k) {
    const typename Row::Vector row = lanes_at<Row>(x + k * Row::count) * (1 / T[k * ld + k]);
    lanes_at<Row>(x + k * Row::count) = row;
    for (int i = k + 1; i < width; ++i) lanes_at<Row>(x + i * Row::count) -= T[k * ld + i] * row;
  }
}

/// One strip of columns of L, N right-hand sides.
template <class Eight, int N>
[[gnu::always_inline]] inline void eliminate_strip(const double* L, std::ptrdiff_t columns, std::ptrdiff_t rows,
                                                   std::ptrdiff_t first, double* x, double* below) {
  using Row = RowLanes<Eight, N>;
  const int width = static_cast<int>(std::min<std::ptrdiff_t>(strip, columns - first));
  const std::ptrdiff_t below_rows = rows - columns, next = first + width;
  const double* block = L + first * rows;
  double plus[strip * Row::count] = {}, minus[strip * Row::count];
  for (int k = 0; k < width; ++k) {
    TOPPLE_UNROLLED
    for (int c = 0; c < N; ++c) plus[k * Row::count + c] = x[c * columns + first + k];
  }
  if (width == strip) {
    solve_strip<Row>(block + first, rows, plus);
  } else {
    solve_narrow_strip<Row>(block + first, rows, width, plus);
  }
  for (int k = 0; k < width; ++k) {
    lanes_at<Row>(minus + k * Row::count) = -lanes_at<Row>(plus + k * Row::count);
    TOPPLE_UNROLLED
    for (int c = 0; c < N; ++c) x[c * columns + first + k] = plus[k * Row::count + c];
  }
  add_columns<Eight, N>(block + next, rows, width, minus, x + next, columns, static_cast<int>(columns - next));
  add_columns<Eight, N>(block + columns, rows, width, plus, below, below_rows, static_cast<int>(below_rows));
}

using Eliminate = void (*)(const double*, int, int, int, double*, double*);
#define TOPPLE_ELIMINATE(N)                                                                                           \
  TOPPLE_EIGHT_LANES(void eliminate_##N(const double* L, int columns, int rows, int first, double* x, double* below), \
                     eliminate_strip<Eight, N>(L, columns, rows, first, x, below);)
TOPPLE_ELIMINATE(1)
TOPPLE_ELIMINATE(2)
TOPPLE_ELIMINATE(3)
TOPPLE_ELIMINATE(4)
TOPPLE_ELIMINATE(5)
TOPPLE_ELIMINATE(6)
#undef TOPPLE_ELIMINATE
constexpr Eliminate eliminate_of[six] = {eliminate_1, eliminate_2, eliminate_3, eliminate_4, eliminate_5, eliminate_6};

/// Columns of W at a time, for M of Y: as many as leave registers for the sums.
template <class Eight, int M>
inline constexpr int columns_together = std::is_same_v<Eight, EightLanes> ? six
                                        : M == 1                          ? 6
                                                                          : 2;

/// C(k, m) += W(:, k) . Y(:, m) for N columns of W and M of Y; each is summed as if it were alone.
template <class Eight, int N, int M>
[[gnu::always_inline]] inline void multiply_columns(const double* W, std::ptrdiff_t stride, const double* Y,
                                                    std::ptrdiff_t Y_stride, int rows, double* C,
                                                    std::ptrdiff_t C_stride) {
  constexpr int lanes = Eight::count, together = columns_together<Eight, M>;
  if constexpr (N > together) {
    multiply_columns<Eight, together, M>(W, stride, Y, Y_stride, rows, C, C_stride);
    multiply_columns<Eight, N - together, M>(W + together * stride, stride, Y, Y_stride, rows, C + together, C_stride);
  } else {
    typename Eight::Vector sum[N * M] = {};
    int i = 0;
    for (; i + lanes <= rows; i += lanes) {
      typename Eight::Vector own[M];
      each_constant<M>([&](auto m) __attribute__((always_inline)) { own[m] = lanes_at<Eight>(Y + m * Y_stride + i); });
      each_constant<N>([&](auto k) __attribute__((always_inline)) {
        const typename Eight::Vector w = lanes_at<Eight>(W + k * stride + i);
        each_constant<M>([&](auto m) __attribute__((always_inline)) { sum[k * M + m] += w * own[m]; });
      });
    }
    each_constant<N * M>([&](auto p) __attribute__((always_inline)) {
      constexpr int k = p / M, m = p % M;
      double part[lanes], last = 0;
      lanes_at<Eight>(part) = sum[p];
      for (int j = i; j < rows; ++j) last += W[k * stride + j] * Y[m * Y_stride + j];
      for (int lane = 0; lane < lanes; ++lane) last += part[lane];
      C[m * C_stride + k] += last;
    });
  }
}

using Multiply = void (*)(const double*, std::ptrdiff_t, const double*, std::ptrdiff_t, int, double*, std::ptrdiff_t);
#define TOPPLE_MULTIPLY_COLUMNS(N, M)                                                                                \
  TOPPLE_EIGHT_LANES(void multiply_##N##_##M(const double* W, std::ptrdiff_t stride, const double* Y,                \
                                             std::ptrdiff_t Y_stride, int rows, double* C, std::ptrdiff_t C_stride), \
                     multiply_columns<Eight, N, M>(W, stride, Y, Y_stride, rows, C, C_stride);)
TOPPLE_MULTIPLY_COLUMNS(1, 1)
TOPPLE_MULTIPLY_COLUMNS(2, 1)
TOPPLE_MULTIPLY_COLUMNS(3, 1)
TOPPLE_MULTIPLY_COLUMNS(4, 1)
TOPPLE_MULTIPLY_COLUMNS(5, 1)
TOPPLE_MULTIPLY_COLUMNS(6, 1)
TOPPLE_MULTIPLY_COLUMNS(6, 3)
#undef TOPPLE_MULTIPLY_COLUMNS
constexpr Multiply multiply_by_three = multiply_6_3;
constexpr Multiply multiply_of[six] = {multiply_1_1, multiply_2_1, multiply_3_1,
                                       multiply_4_1, multiply_5_1, multiply_6_1};

template <class Eight>
[[gnu::always_inline]] inline void combine(const double* W, std::ptrdiff_t stride, int columns, const double* c,
                                           double* y, int rows) {
  if (columns == strip) {
    add_columns<Eight, 1>(W, stride, strip, c, y, 0, rows);
  } else {
    add_columns<Eight, 1>(W, stride, columns, c, y, 0, rows);
  }
}
TOPPLE_EIGHT_LANES(void add_combination(const double* W, std::ptrdiff_t stride, int columns, const double* c, double* y,
                                        int rows),
                   combine<Eight>(W, stride, columns, c, y, rows);)

}  // namespace

void add_products(const double* W, int stride, int rows, int columns, const double* y, double* c) {
  add_products(W, stride, rows, columns, y, rows, 1, c, columns);
}

void add_products(const double* W, int stride, int rows, int columns, const double* Y, int Y_stride, int count,
                  double* C, int C_stride) {
  constexpr int together = 3;
  for (int k = 0; k < columns; k += six) {
    const double* own = W + static_cast<std::ptrdiff_t>(k) * stride;
    const int width = std::min(six, columns - k);
    for (int m = 0; m < count;) {
      const int taken = width == six && m + together <= count ? together : 1;
      const Multiply multiply = taken == together ? multiply_by_three : multiply_of[width - 1];
      multiply(own, stride, Y + static_cast<std::ptrdiff_t>(m) * Y_stride, Y_stride, rows,
               C + static_cast<std::ptrdiff_t>(m) * C_stride + k, C_stride);
      m += taken;
    }
  }
}

void subtract_combination(const double* W, int stride, int rows, int columns, const double* c, double* y) {
  double minus[strip];
  for (int k = 0; k < columns; k += strip) {
    const int width = std::min(strip, columns - k);
    for (int i = 0; i < width; ++i) minus[i] = -c[k + i];
    add_combination(W + static_cast<std::ptrdiff_t>(k) * stride, stride, width, minus, y, rows);
  }
}

void eliminate_right_hand_sides(const double* L, int columns, int rows, double* x, int count, double* below) {
  const int below_rows = rows - columns;
  std::fill(below, below + static_cast<std::ptrdiff_t>(below_rows) * count, 0.0);
  const auto eliminate = [&](int first, int c) {
    eliminate_of[std::min(six, count - c) - 1](L, columns, rows, first, x + static_cast<std::ptrdiff_t>(c) * columns,
                                               below + static_cast<std::ptrdiff_t>(c) * below_rows);
  };
  // A panel that stays in the cache serves some right-hand sides after the others, which then stay nearer still. A
  // larger one comes from memory once, strip by strip.
  if (static_cast<std::ptrdiff_t>(columns) * rows <= panel_in_cache) {
    for (int c = 0; c < count; c += six)
      for (int first = 0; first < columns; first += strip) eliminate(first, c);
  } else {
    for (int first = 0; first < columns; first += strip)
      for (int c = 0; c < count; c += six) eliminate(first, c);
  }
}

}  // namespace topple::solver
