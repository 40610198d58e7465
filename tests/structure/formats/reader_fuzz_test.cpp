// Readers against files that were changed at random; scripts/stress readers runs more of them under the sanitizers.
#include <catch2/catch.hpp>

#include "fuzzed_readers.h"

using namespace topple::test;

namespace {

void check(const FuzzTally& tally) {
  INFO(tally.fault);
  REQUIRE(tally.fault.empty());
  CHECK(tally.accepted > fuzz_rounds / 200);  // the changes reach behind the syntax
  CHECK(tally.refused > fuzz_rounds / 20);
}

}  // namespace

TEST_CASE("mutated models give a sound building or one clear line") { check(fuzz_models(fuzz_rounds)); }

TEST_CASE("mutated .3dd files give a sound building or one clear line") { check(fuzz_frame3dd(fuzz_rounds)); }

TEST_CASE("mutated tables give a sound building or one clear line") { check(fuzz_tables(fuzz_rounds)); }

TEST_CASE("mutated tables with decimal commas give a sound building or one clear line") {
  check(fuzz_european_tables(fuzz_rounds));
}

TEST_CASE("mutated scenarios give a scenario of its model or one clear line") { check(fuzz_scenarios(fuzz_rounds)); }
