#include "parallel/one_blas_thread.h"

extern "C" {
void openblas_set_num_threads(int);
int openblas_get_num_threads();
}

namespace topple::solver {

void use_one_blas_thread() {
  if (openblas_get_num_threads() != 1) openblas_set_num_threads(1);
}

}  // namespace topple::solver
