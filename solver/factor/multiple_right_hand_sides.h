#pragma once
// Elimination with a dense block of a factor, for one right-hand side or many. For a handful (an element has six) BLAS
// packs the block, which costs more than the arithmetic; here it is read once, eight columns at a time. For many BLAS
// would gain a little, but sums in the order of its processor. The same goes for columns that meet one vector.

namespace topple::solver {

/// L: `columns` columns of `rows` entries, the triangle first. x (columns x count) := triangle^-1 x, and below
/// ((rows - columns) x count) := rectangle x. Every entry is summed in order of L's columns, by itself: the bits do not
/// depend on the processor's vectors, nor on how many right-hand sides there are.
void eliminate_right_hand_sides(const double* L, int columns, int rows, double* x, int count, double* below);

/// W: `columns` columns of `rows` entries, one every `stride`. c(k) += W(:, k) . y, always in the same order.
void add_products(const double* W, int stride, int rows, int columns, const double* y, double* c);
/// C(k, m) += W(:, k) . Y(:, m) for `count` columns of Y, each by itself as above, so that the bits are the same.
void add_products(const double* W, int stride, int rows, int columns, const double* Y, int Y_stride, int count,
                  double* C, int C_stride);
/// y -= W c.
void subtract_combination(const double* W, int stride, int rows, int columns, const double* c, double* y);

}  // namespace topple::solver
