// Every file that a fuzzer found worth keeping, read again: scripts/stress fuzz looks for more.
#include <catch2/catch.hpp>

#include "fuzz/targets.h"
#include "support/source_tree.h"
#include "topple/structure/formats/input_files.h"

TEST_CASE("what fuzzers found is read or refused as promised") {
  for (const auto& [name, target] : topple::fuzz::targets()) {
    std::size_t read = 0;
    const auto corpus = std::filesystem::path(topple::test::in_source_tree("tests/fuzz/corpus")) / name;
    for (const auto& entry : std::filesystem::directory_iterator(corpus)) {
      INFO(entry.path().string());
      CHECK_NOTHROW(target(topple::structure::read_whole_file(entry.path())));
      ++read;
    }
    INFO(name);
    CHECK(read > 0);
  }
}
