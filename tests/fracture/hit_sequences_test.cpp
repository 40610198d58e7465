// Whatever is hit, nothing is lost: random sequences on random panels, for each method.
#include <catch2/catch.hpp>

#include "hit_sequences.h"

using namespace topple::fracture;

// The long run, 10,000 sequences of each under the sanitizers, is scripts/stress fracture.
TEST_CASE("no sequence of hits loses area or tears a mesh") {
  for (const Method method : {Method::voronoi, Method::quadrilateral, Method::local}) {
    test::Tally tally;
    for (unsigned number = 0; number < 100; ++number) {
      const std::string fault = test::run_sequence(method, number, 12, &tally);
      INFO("method " << static_cast<int>(method));
      CHECK(fault == "");
    }
    CHECK(tally.chunks > 1000);  // the hits did hit
  }
}
