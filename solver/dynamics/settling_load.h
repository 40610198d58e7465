#pragma once
// A load over a substep that depends on the motion at the substep's end: found by fixed-point iteration.
#include <Eigen/Core>

namespace topple::solver {

class SettlingLoad {
 public:
  /// Over all of the substep as at its start, until a pass says otherwise.
  void begin(Eigen::VectorXd at_start);
  enum class Pass { settled, open, lost };
  /// What follows from the motion that the load at the end made. Settled: so little else that it stays as it was. Lost:
  /// nothing that could be used.
  [[nodiscard]] Pass iterate(Eigen::VectorXd at_end);
  /// Over all of the substep as at its start.
  void give_up() { end_ = start_; }
  /// Adds it at the share `start` of the start of the substep and the rest of its end.
  void add_to(double start, Eigen::VectorXd& load) const { load += start * start_ + (1 - start) * end_; }

 private:
  Eigen::VectorXd start_, end_;
};

}  // namespace topple::solver
