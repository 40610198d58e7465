// stress_fracture [SEQUENCES [HITS]]: random sequences of hits on random panels, for each method (10000 of 12 hits).
#include <cstdio>
#include <cstdlib>
#include <exception>

#include "fracture/hit_sequences.h"

int main(int argc, char** argv) {
  using namespace topple::fracture;
  const int sequences = argc > 1 ? std::atoi(argv[1]) : 10000, hits = argc > 2 ? std::atoi(argv[2]) : 12;
  int failures = 0;
  const char* names[] = {"voronoi", "quadrilateral", "local"};
  for (const Method method : {Method::voronoi, Method::quadrilateral, Method::local}) {
    int failed = 0;
    test::Tally tally;
    for (int number = 0; number < sequences; ++number) {
      std::string fault;
      try {
        fault = test::run_sequence(method, static_cast<unsigned>(number), hits, &tally);
      } catch (const std::exception& error) {
        fault = "sequence " + std::to_string(number) + " ends with: " + error.what();
      }
      if (fault.empty()) continue;
      if (++failed <= 20) std::printf("%s: %s\n", names[static_cast<int>(method)], fault.c_str());
    }
    std::printf("%s: %d sequences, %zu chunks, largest area error %.2g, %d failures\n", names[static_cast<int>(method)],
                sequences, tally.chunks, tally.area_error, failed);
    failures += failed;
  }
  return failures == 0 ? 0 : 1;
}
