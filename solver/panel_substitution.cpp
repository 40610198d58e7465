#include "panel_substitution.h"

#include <algorithm>
#include <cstddef>

#include "vector_versions.h"

namespace topple::solver {
namespace {

constexpr int strip = 8, lanes = 8, most_together = 4;
using Vector = double __attribute__((vector_size(lanes * sizeof(double)), aligned(sizeof(double)), may_alias));

const Vector& vector_at(const double* p) { return *reinterpret_cast<const Vector*>(p); }

/// sum[k * most_together + c] := the product of column k of L and column c of b, k < 8, c < N.
template <int N>
[[gnu::always_inline]] inline void products(const double* L, std::ptrdiff_t ld, const double* b, std::ptrdiff_t stride,
                                            int rows, double* sum) {
  // Four columns of L at a time leave registers for the sums.
  for (int half = 0; half < strip; half += 4) {
    Vector part[4][N];
    for (int k = 0; k < 4; ++k)
      for (int c = 0; c < N; ++c) part[k][c] = Vector{};
    const double* l = L + half * ld;
    int i = 0;
    for (; i + lanes <= rows; i += lanes)
      for (int k = 0; k < 4; ++k) {
        const Vector v = vector_at(l + k * ld + i);
        for (int c = 0; c < N; ++c) part[k][c] += v * vector_at(b + c * stride + i);
      }
    for (int k = 0; k < 4; ++k)
      for (int c = 0; c < N; ++c) {
        for (int r = i; r < rows; ++r) part[k][c][r - i] += l[k * ld + r] * b[c * stride + r];
        const Vector& p = part[k][c];
        sum[(half + k) * most_together + c] = ((p[0] + p[4]) + (p[2] + p[6])) + ((p[1] + p[5]) + (p[3] + p[7]));
      }
  }
}

using Products = void (*)(const double*, std::ptrdiff_t, const double*, std::ptrdiff_t, int, double*);

TOPPLE_VECTOR_VERSIONS
void products_1(const double* L, std::ptrdiff_t ld, const double* b, std::ptrdiff_t stride, int rows, double* sum) {
  products<1>(L, ld, b, stride, rows, sum);
}
TOPPLE_VECTOR_VERSIONS
void products_2(const double* L, std::ptrdiff_t ld, const double* b, std::ptrdiff_t stride, int rows, double* sum) {
  products<2>(L, ld, b, stride, rows, sum);
}
TOPPLE_VECTOR_VERSIONS
void products_3(const double* L, std::ptrdiff_t ld, const double* b, std::ptrdiff_t stride, int rows, double* sum) {
  products<3>(L, ld, b, stride, rows, sum);
}
TOPPLE_VECTOR_VERSIONS
void products_4(const double* L, std::ptrdiff_t ld, const double* b, std::ptrdiff_t stride, int rows, double* sum) {
  products<4>(L, ld, b, stride, rows, sum);
}
constexpr Products products_of[most_together] = {products_1, products_2, products_3, products_4};

/// x -= L' b for `width` (at most 8) columns of L.
void subtract_products(const double* L, std::ptrdiff_t ld, int width, const double* b, std::ptrdiff_t stride, int rows,
                       double* x, std::ptrdiff_t x_stride, int count) {
  if (rows <= 0) return;
  if (width == strip) {
    double sum[strip * most_together];
    products_of[count - 1](L, ld, b, stride, rows, sum);
    for (int c = 0; c < count; ++c)
      for (int k = 0; k < strip; ++k) x[c * x_stride + k] -= sum[k * most_together + c];
    return;
  }
  // The same parts, column by column.
  for (int c = 0; c < count; ++c)
    for (int k = 0; k < width; ++k) {
      double part[lanes] = {};
      const double *l = L + k * ld, *right = b + c * stride;
      for (int i = 0; i < rows; ++i) part[i % lanes] += l[i] * right[i];
      x[c * x_stride + k] -= ((part[0] + part[4]) + (part[2] + part[6])) + ((part[1] + part[5]) + (part[3] + part[7]));
    }
}

/// One strip of columns of L, at most four right-hand sides.
void substitute(const double* L, int columns, int rows, int first, double* x, int count, const double* below) {
  const int below_rows = rows - columns, width = std::min(strip, columns - first), next = first + width;
  const double* block = L + static_cast<std::ptrdiff_t>(first) * rows;
  subtract_products(block + columns, rows, width, below, below_rows, below_rows, x + first, columns, count);
  subtract_products(block + next, rows, width, x + next, columns, columns - next, x + first, columns, count);
  for (int c = 0; c < count; ++c) {
    double* own = x + static_cast<std::ptrdiff_t>(c) * columns + first;
    for (int k = width; k-- > 0;) {
      const double* column = block + static_cast<std::ptrdiff_t>(k) * rows + first;
      double sum = own[k];
      for (int i = k + 1; i < width; ++i) sum -= column[i] * own[i];
      own[k] = sum / column[k];
    }
  }
}

}  // namespace

void substitute_back(const double* L, int columns, int rows, double* x, int count, const double* below) {
  // Strip by strip for all right-hand sides: a strip stays in the cache, the panel comes from memory once.
  for (int first = (columns - 1) / strip * strip; first >= 0; first -= strip)
    for (int c = 0; c < count; c += most_together)
      substitute(L, columns, rows, first, x + static_cast<std::ptrdiff_t>(c) * columns,
                 std::min(most_together, count - c), below + static_cast<std::ptrdiff_t>(c) * (rows - columns));
}

}  // namespace topple::solver
