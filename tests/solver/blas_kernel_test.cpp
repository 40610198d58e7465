// What a program does about BLAS before anything else.
#include "topple/solver/blas_kernel.h"

#include <catch2/catch.hpp>
#include <fstream>
#include <string>

TEST_CASE("A program that has prepared BLAS has no threads of BLAS beside it") {
  std::ifstream status("/proc/self/status");
  if (!status) return;  // no such file, no such threads: prepare_blas does nothing there
  std::string key;
  int threads = 0;
  while (status >> key)
    if (key == "Threads:") status >> threads;
  CHECK(threads == 1);
}
