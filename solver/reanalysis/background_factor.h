#pragma once
// A new factor made on a thread of its own, of the matrix as it was when it was begun, while the old one is in use.
#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <thread>
#include <vector>

#include "assembly/sparse.h"
#include "factor/factor.h"
#include "factor/triangular.h"

namespace topple::solver {

class BackgroundFactor {
 public:
  /// Copies what it needs and begins. `on_worker` (may be empty) runs first, on the new thread.
  BackgroundFactor(const SparseSymmetric& matrix, const std::vector<int>& order, const AnalysisOptions& options,
                   std::function<void()> on_worker);
  /// Waits for the thread.
  ~BackgroundFactor();
  BackgroundFactor(const BackgroundFactor&) = delete;
  BackgroundFactor& operator=(const BackgroundFactor&) = delete;

  struct Result {
    std::unique_ptr<Factor> factor;  ///< none: the matrix is not definite, or lies in the warning band
    double condition = 0;
    std::optional<TriangularSolver> triangles;  ///< over the factor
    std::vector<double> values;                 ///< of the matrix that it was made of
  };
  /// Waits for the factor; once. `late`: it was not there yet.
  [[nodiscard]] Result extract(bool& late);
  /// What it is made of; until extract().
  [[nodiscard]] const SparseSymmetric& matrix() const { return matrix_; }

 private:
  void make(const std::vector<int>& order, const AnalysisOptions& options);

  SparseSymmetric matrix_;
  Result result_;
  std::atomic<bool> done_{false};
  std::thread thread_;
};

}  // namespace topple::solver
