// stress_readers [ROUNDS]: every reader (models, .3dd, tables with either kind of comma, scenarios) against so many
// files (10000) that were changed at random. A crash or what the sanitizers find ends the run; a hang is the caller's
// to see.
#include <cstdio>
#include <cstdlib>

#include "structure/fuzzed_readers.h"

int main(int argc, char** argv) {
  using namespace topple::test;
  const int rounds = argc > 1 ? std::atoi(argv[1]) : 10000;
  struct Reader {
    const char* name;
    FuzzTally (*fuzz)(int);
  };
  int failures = 0;
  for (const auto& [name, fuzz] :
       {Reader{"models", fuzz_models}, Reader{".3dd files", fuzz_frame3dd}, Reader{"tables", fuzz_tables},
        Reader{"tables with decimal commas", fuzz_european_tables}, Reader{"scenarios", fuzz_scenarios}}) {
    const FuzzTally tally = fuzz(rounds);
    std::printf("%s: %d accepted, %d refused\n", name, tally.accepted, tally.refused);
    std::fflush(stdout);
    if (tally.fault.empty()) continue;
    ++failures;
    std::printf("%s\n", tally.fault.c_str());
  }
  return failures == 0 ? 0 : 1;
}
