// Memory of factors that follow each other.
#include "factor/large_buffer.h"

#include <catch2/catch.hpp>
#include <new>
#include <vector>

#include "topple/solver/kept_memory.h"

using namespace topple::solver;

TEST_CASE("Of what factors let go of the largest blocks wait for the next one, however many small ones came before") {
  constexpr std::size_t little = std::size_t{1} << 20, much = std::size_t{1} << 22;
  const KeptMemory kept;
  std::vector<LargeBuffer> small;
  for (int n = 0; n < 12; ++n) small.emplace_back(little);
  LargeBuffer large(much);
  const double* const memory = large.data();
  small.clear();
  large.release();
  // Memory that was given back to the system would be here.
  constexpr std::align_val_t line{64};
  void* const other = ::operator new(much * sizeof(double), line);
  CHECK(LargeBuffer(much).data() == memory);
  ::operator delete(other, line);
}
