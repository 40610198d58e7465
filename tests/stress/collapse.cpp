// stress_collapse [SCENARIOS [FIRST [moving]]]: random buildings under random tools, run to rest (200 from number 0).
// What stands is at rest, or moves.
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>

#include "structure/random_collapse.h"
#include "topple/structure/error.h"

int main(int argc, char** argv) {
  const int scenarios = argc > 1 ? std::atoi(argv[1]) : 200, first = argc > 2 ? std::atoi(argv[2]) : 0;
  const bool moving = argc > 3 && std::strcmp(argv[3], "moving") == 0;
  if (argc > 4 || (argc > 3 && !moving)) {
    std::fprintf(stderr, "stress_collapse [SCENARIOS [FIRST [moving]]]\n");
    return 2;
  }
  int failures = 0;
  for (int number = first; number < first + scenarios; ++number) {
    std::string fault;
    try {
      const auto seed = static_cast<std::uint64_t>(number);
      fault = moving ? topple::test::fault_of_moving_collapse(seed) : topple::test::fault_of_collapse(seed);
    } catch (const topple::structure::UnstableModel&) {
      std::printf("scenario %d: does not stand at the start\n", number);
      continue;
    } catch (const std::exception& error) {
      fault = std::string("ends with: ") + error.what();
    }
    if (fault.empty()) continue;
    ++failures;
    std::printf("scenario %d: %s\n", number, fault.c_str());
    std::fflush(stdout);
  }
  std::printf("%d scenarios, %d failures\n", scenarios, failures);
  return failures == 0 ? 0 : 1;
}
