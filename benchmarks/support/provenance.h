#pragma once
// What a figure needs beside it to be worth anything: source, compiler, flags, processor, BLAS kernels, threads.
#include <cstdio>
#include <fstream>
#include <string>

#include "topple/solver/blas_kernel.h"

namespace topple::bench {

inline std::string processor() {
  std::ifstream info("/proc/cpuinfo");
  std::string line, name = "unknown", family, model;
  while (std::getline(info, line) && !line.empty()) {
    const auto colon = line.find(": ");
    if (colon == std::string::npos) continue;
    const std::string value = line.substr(colon + 2);
    if (line.starts_with("model name")) name = value;
    if (line.starts_with("cpu family")) family = value;
    if (line.starts_with("model\t")) model = value;
  }
  return name + " (family " + family + ", model " + model + ")";
}

/// Prints the lines that stand above every table of figures. `threads` is what the measured code was allowed.
inline void print_provenance(const char* title, int threads) {
  std::printf("%s\n", title);
  std::printf("  source      %s\n", TOPPLE_BENCH_COMMIT);
  std::printf("  compiler    %s, flags %s\n", TOPPLE_BENCH_COMPILER, TOPPLE_BENCH_FLAGS);
  std::printf("  processor   %s\n", processor().c_str());
  std::printf("  BLAS        OpenBLAS, %s kernels, 1 thread; program on %d thread%s\n\n", solver::blas_kernel().c_str(),
              threads, threads == 1 ? "" : "s");
}

}  // namespace topple::bench
