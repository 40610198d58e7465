// stress_reanalysis [FRAMES [CHANGES [FIRST]]]: random frames (1000, numbered from FIRST) that change at random (100
// times each), every answer of the ladder against a fresh analysis, every mechanism against its verdict.
#include <cstdio>
#include <cstdlib>
#include <exception>

#include "solver/changing_frame.h"

int main(int argc, char** argv) {
  using namespace topple::test;
  const int frames = argc > 1 ? std::atoi(argv[1]) : 1000, changes = argc > 2 ? std::atoi(argv[2]) : 100;
  const unsigned first = argc > 3 ? static_cast<unsigned>(std::atoi(argv[3])) : 0;
  ChangeTally tally;
  int failures = 0;
  for (unsigned n = first; n < first + static_cast<unsigned>(frames); ++n) {
    std::string fault;
    try {
      ChangingFrame frame = numbered_frame(n);
      fault = follow(frame, changes, tally);
    } catch (const std::exception& error) {
      fault = std::string("ends with: ") + error.what();
    }
    if (!fault.empty() && ++failures <= 20) std::printf("frame %u, %s\n", n, fault.c_str());
  }
  const auto& rungs = tally.rungs;
  std::printf("%d frames, %ld answers, %ld mechanisms (%ld of them parts that split off), %ld in the warning band\n",
              frames, tally.answers, tally.mechanisms, tally.splits, tally.in_warning_band);
  std::printf("rungs: unchanged %llu, loads %llu, corrections %llu, new factors %llu\n",
              static_cast<unsigned long long>(rungs.unchanged), static_cast<unsigned long long>(rungs.load_solves),
              static_cast<unsigned long long>(rungs.low_rank), static_cast<unsigned long long>(rungs.refactorisations));
  std::printf("largest difference %.2g of what is allowed; %d failures\n", tally.difference, failures);
  return failures == 0 ? 0 : 1;
}
