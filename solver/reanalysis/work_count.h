#pragma once
// The predicted work of the answers that a thread computes. A new factor that another thread makes is due when they
// have taken a share of what it takes: at an answer fixed by counts, whatever the clock says.

namespace topple::solver {

/// Adds what something takes, in nanoseconds of the machine that the costs in update_costs.cpp were measured on.
void count_work(double nanoseconds);
/// What its thread counts while it lives. That begins at nothing: its bits do not depend on what was counted before.
class CountedWork {
 public:
  CountedWork();
  ~CountedWork();
  CountedWork(const CountedWork&) = delete;
  CountedWork& operator=(const CountedWork&) = delete;
  [[nodiscard]] double so_far() const;

 private:
  double before_;
};

}  // namespace topple::solver
