#pragma once
// Published answers beside ours: each is checked when it is met, and all that were met are printed as a table when the
// program ends (the one in docs/verification.md).
#include <string>

namespace topple::test {

struct Answer {
  std::string problem, source;
  double expected = 0, measured = 0;
};

/// Fails when the relative difference is above `asked`.
void judge(const Answer& answer, double asked);
/// For the table alone: an answer that no element of its kind can reach, or a coarser mesh on the way.
void show(const Answer& answer, const std::string& why);

}  // namespace topple::test
