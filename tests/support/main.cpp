#define CATCH_CONFIG_RUNNER
#include <catch2/catch.hpp>

#include "topple/solver/blas_kernel.h"

int main(int argc, char** argv) {
  topple::solver::prepare_blas(argv);
  return Catch::Session().run(argc, argv);
}
