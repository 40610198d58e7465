#include "eigen/tall_products.h"

#include <algorithm>
#include <vector>

#include "topple/solver/parallel_for.h"

namespace topple::solver {
namespace {

constexpr Eigen::Index block_rows = 8192;

int blocks_of(Eigen::Index rows) { return static_cast<int>((rows + block_rows - 1) / block_rows); }

/// Calls visit(block, first row, rows).
template <class Visit>
void each_block(Eigen::Index rows, int threads, const Visit& visit) {
  parallel_for(blocks_of(rows), threads, [&](int block) {
    const Eigen::Index first = block * block_rows;
    visit(static_cast<std::size_t>(block), first, std::min(block_rows, rows - first));
  });
}

}  // namespace

Eigen::MatrixXd tall_product(const Eigen::Ref<const Eigen::MatrixXd>& A, const Eigen::Ref<const Eigen::MatrixXd>& B,
                             int threads) {
  std::vector<Eigen::MatrixXd> parts(static_cast<std::size_t>(blocks_of(A.rows())));
  each_block(A.rows(), threads, [&](std::size_t block, Eigen::Index first, Eigen::Index rows) {
    parts[block].noalias() = A.middleRows(first, rows).transpose() * B.middleRows(first, rows);
  });
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(A.cols(), B.cols());
  for (const Eigen::MatrixXd& part : parts) sum += part;
  return sum;
}

void subtract_tall(const Eigen::Ref<const Eigen::MatrixXd>& A, const Eigen::MatrixXd& C, Eigen::Ref<Eigen::MatrixXd> Y,
                   int threads) {
  each_block(A.rows(), threads, [&](std::size_t, Eigen::Index first, Eigen::Index rows) {
    Y.middleRows(first, rows).noalias() -= A.middleRows(first, rows) * C;
  });
}

}  // namespace topple::solver
