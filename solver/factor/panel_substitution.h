#pragma once
// Back substitution with a dense panel of a factor for one or several right-hand sides: the panel is read once for up
// to four of them, eight columns at a time.

namespace topple::solver {

/// L: `columns` columns of `rows` entries, the triangle first. x (columns x count) := triangle^-T (x - rectangle'
/// below), below ((rows - columns) x count). Every sum is formed in eight parts, by row modulo eight, whatever the
/// processor's vectors: the bits do not depend on them, nor on how many right-hand sides there are.
void substitute_back(const double* L, int columns, int rows, double* x, int count, const double* below);

}  // namespace topple::solver
