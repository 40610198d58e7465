#pragma once
// The predicted work of the answers that a thread computes. A new factor that another thread makes is due when they
// have taken a share of what it takes: at an answer fixed by counts, whatever the clock says.

namespace topple::solver {

/// Adds what something takes, in nanoseconds of the machine that the costs in update_costs.cpp were measured on.
void count_work(double nanoseconds);
/// All that this thread has counted.
[[nodiscard]] double counted_work();

}  // namespace topple::solver
