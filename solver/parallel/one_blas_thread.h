#pragma once

namespace topple::solver {

/// BLAS runs on one thread, always: with more it sums in another order and gives other bits, and waits for threads that
/// the small blocks of a factor never keep busy. Said by everything that makes a factor, whichever it is.
void use_one_blas_thread();

}  // namespace topple::solver
