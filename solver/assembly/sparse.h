#pragma once
#include <cstdint>
#include <vector>

namespace topple::solver {

/// Lower triangle of a symmetric matrix by columns: rows ascend within a column and start with the diagonal.
struct SparseSymmetric {
  std::int32_t size = 0;
  std::vector<std::int64_t> start;  ///< size + 1
  std::vector<std::int32_t> row;
  std::vector<double> value;
};

}  // namespace topple::solver
