#pragma once
#include <cstdint>
#include <span>

namespace topple::solver {

/// The numbers of a factor as they lie, in elimination order. Supernodal (and multifrontal), L L': block b has the
/// columns first[b] ... first[b + 1] - 1; row[row_start[b]] ... are its rows (its own first), and value[start[b]] ...
/// its dense columns. Simplicial: column j has row[start[j]] ... (count[j] of them, the diagonal first) and
/// value[start[j]] ... of L, or of L D L' with D in the place of L's unit diagonal.
struct FactorView {
  bool supernodal = false, is_ll = false;
  std::span<const std::int64_t> order, first, row_start, start, count, row;
  std::span<const double> value;
};

}  // namespace topple::solver
