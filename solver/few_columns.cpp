#include "few_columns.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include "vector_versions.h"

namespace topple::solver {
namespace {

constexpr int strip = 8;  // columns of L at a time
constexpr int six = 6;    // right-hand sides at a time
constexpr int lanes = 8;
using Vector = double __attribute__((vector_size(lanes * sizeof(double)), aligned(sizeof(double)), may_alias));
using Coefficients = std::array<double, strip * six>;

const Vector& vector_at(const double* p) { return *reinterpret_cast<const Vector*>(p); }
Vector& vector_at(double* p) { return *reinterpret_cast<Vector*>(p); }

/// target(i, c) += sum over k < width of L(i, k) coefficient[k six + c], for N columns of the target.
template <int N>
[[gnu::always_inline]] inline void add_columns(const double* L, std::ptrdiff_t ld, int width, const double* coefficient,
                                               double* target, std::ptrdiff_t stride, int rows) {
  int i = 0;
  for (; i + lanes <= rows; i += lanes) {
    Vector sum[N];
    for (int c = 0; c < N; ++c) sum[c] = vector_at(target + c * stride + i);
    for (int k = 0; k < width; ++k) {
      const Vector l = vector_at(L + k * ld + i);
      for (int c = 0; c < N; ++c) sum[c] += l * coefficient[k * six + c];
    }
    for (int c = 0; c < N; ++c) vector_at(target + c * stride + i) = sum[c];
  }
  for (; i < rows; ++i)
    for (int c = 0; c < N; ++c)
      for (int k = 0; k < width; ++k) target[c * stride + i] += L[k * ld + i] * coefficient[k * six + c];
}

using Add = void (*)(const double*, std::ptrdiff_t, int, const double*, double*, std::ptrdiff_t, int);
#define TOPPLE_ADD_COLUMNS(N)                                                                            \
  TOPPLE_VECTOR_VERSIONS                                                                                 \
  void add_##N(const double* L, std::ptrdiff_t ld, int width, const double* coefficient, double* target, \
               std::ptrdiff_t stride, int rows) {                                                        \
    add_columns<N>(L, ld, width, coefficient, target, stride, rows);                                     \
  }
TOPPLE_ADD_COLUMNS(1)
TOPPLE_ADD_COLUMNS(2)
TOPPLE_ADD_COLUMNS(3)
TOPPLE_ADD_COLUMNS(4)
TOPPLE_ADD_COLUMNS(5)
TOPPLE_ADD_COLUMNS(6)
#undef TOPPLE_ADD_COLUMNS
constexpr Add add_of[six] = {add_1, add_2, add_3, add_4, add_5, add_6};

void add(const double* L, int ld, int width, const Coefficients& coefficient, double* target, int stride, int rows,
         int count) {
  if (rows > 0) add_of[count - 1](L, ld, width, coefficient.data(), target, stride, rows);
}

/// One strip of columns of L, at most six right-hand sides.
void eliminate(const double* L, int columns, int rows, int first, double* x, int count, double* below) {
  const int below_rows = rows - columns, width = std::min(strip, columns - first), next = first + width;
  Coefficients minus{}, plus{};
  const double* block = L + static_cast<std::ptrdiff_t>(first) * rows;
  for (int c = 0; c < count; ++c) {
    double* own = x + static_cast<std::ptrdiff_t>(c) * columns + first;
    for (int k = 0; k < width; ++k) {
      const double* column = block + static_cast<std::ptrdiff_t>(k) * rows + first;
      const double value = own[k] /= column[k];
      for (int i = k + 1; i < width; ++i) own[i] -= column[i] * value;
      plus[static_cast<std::size_t>(k * six + c)] = value;
      minus[static_cast<std::size_t>(k * six + c)] = -value;
    }
  }
  add(block + next, rows, width, minus, x + next, columns, columns - next, count);
  add(block + columns, rows, width, plus, below, below_rows, below_rows, count);
}

/// c(k) += W(:, k) . y for N columns.
template <int N>
[[gnu::always_inline]] inline void multiply_columns(const double* W, std::ptrdiff_t stride, const double* y, int rows,
                                                    double* c) {
  Vector sum[N] = {};
  int i = 0;
  for (; i + lanes <= rows; i += lanes) {
    const Vector own = vector_at(y + i);
    for (int k = 0; k < N; ++k) sum[k] += vector_at(W + k * stride + i) * own;
  }
  for (int k = 0; k < N; ++k) {
    double last = 0;
    for (int j = i; j < rows; ++j) last += W[k * stride + j] * y[j];
    for (int lane = 0; lane < lanes; ++lane) last += sum[k][lane];
    c[k] += last;
  }
}

using Multiply = void (*)(const double*, std::ptrdiff_t, const double*, int, double*);
#define TOPPLE_MULTIPLY_COLUMNS(N)                                                                  \
  TOPPLE_VECTOR_VERSIONS                                                                            \
  void multiply_##N(const double* W, std::ptrdiff_t stride, const double* y, int rows, double* c) { \
    multiply_columns<N>(W, stride, y, rows, c);                                                     \
  }
TOPPLE_MULTIPLY_COLUMNS(1)
TOPPLE_MULTIPLY_COLUMNS(2)
TOPPLE_MULTIPLY_COLUMNS(3)
TOPPLE_MULTIPLY_COLUMNS(4)
TOPPLE_MULTIPLY_COLUMNS(5)
TOPPLE_MULTIPLY_COLUMNS(6)
#undef TOPPLE_MULTIPLY_COLUMNS
constexpr Multiply multiply_of[six] = {multiply_1, multiply_2, multiply_3, multiply_4, multiply_5, multiply_6};

}  // namespace

void add_products(const double* W, int stride, int rows, int columns, const double* y, double* c) {
  for (int k = 0; k < columns; k += six)
    multiply_of[std::min(six, columns - k) - 1](W + static_cast<std::ptrdiff_t>(k) * stride, stride, y, rows, c + k);
}

void subtract_combination(const double* W, int stride, int rows, int columns, const double* c, double* y) {
  Coefficients minus{};
  for (int k = 0; k < columns; k += strip) {
    const int width = std::min(strip, columns - k);
    for (int i = 0; i < width; ++i) minus[static_cast<std::size_t>(i * six)] = -c[k + i];
    add_1(W + static_cast<std::ptrdiff_t>(k) * stride, stride, width, minus.data(), y, 0, rows);
  }
}

void eliminate_few_columns(const double* L, int columns, int rows, double* x, int count, double* below) {
  const int below_rows = rows - columns;
  std::fill(below, below + static_cast<std::ptrdiff_t>(below_rows) * count, 0.0);
  // Strip by strip for all right-hand sides: a strip stays in the cache, the panel comes from memory once.
  for (int first = 0; first < columns; first += strip)
    for (int c = 0; c < count; c += six)
      eliminate(L, columns, rows, first, x + static_cast<std::ptrdiff_t>(c) * columns, std::min(six, count - c),
                below + static_cast<std::ptrdiff_t>(c) * below_rows);
}

}  // namespace topple::solver
