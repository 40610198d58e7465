// stress_collapse [SCENARIOS [FIRST]]: random buildings under random tools, run to rest (200 from number 0).
#include <cstdio>
#include <cstdlib>
#include <exception>

#include "structure/random_collapse.h"
#include "topple/structure/error.h"

int main(int argc, char** argv) {
  const int scenarios = argc > 1 ? std::atoi(argv[1]) : 200, first = argc > 2 ? std::atoi(argv[2]) : 0;
  int failures = 0;
  for (int number = first; number < first + scenarios; ++number) {
    std::string fault;
    try {
      fault = topple::test::fault_of_collapse(static_cast<std::uint64_t>(number));
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
