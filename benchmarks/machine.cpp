// What this machine can do at most: the rate of the matrix product (OpenBLAS) and the memory's bandwidth (triad
// a = b + s c over arrays that fit no cache), on one thread and on all. Writes one JSON object.
//   bench_machine
#include <algorithm>
#include <cstdio>
#include <thread>
#include <vector>

#include "support/measure.h"
#include "topple/solver/blas_kernel.h"

extern "C" {
void openblas_set_num_threads(int);
void dgemm_(const char*, const char*, const int*, const int*, const int*, const double*, const double*, const int*,
            const double*, const int*, const double*, double*, const int*);
}

namespace {

using namespace topple::bench;

/// Multiplications and additions in a second.
Spread product_rate(int threads) {
  constexpr int n = 1536, rounds = 7;
  const std::vector<double> a(static_cast<std::size_t>(n) * n, 0.5), b(a);
  std::vector<double> c(a.size()), rates;
  const double one = 1, zero = 0;
  openblas_set_num_threads(threads);
  for (int i = 0; i <= rounds; ++i) {
    const double t =
        seconds([&] { dgemm_("N", "N", &n, &n, &n, &one, a.data(), &n, b.data(), &n, &zero, c.data(), &n); });
    if (i > 0) rates.push_back(2.0 * n * n * n / t);
  }
  openblas_set_num_threads(1);
  return spread_of(rates);
}

/// Bytes in a second: two arrays read, one written.
Spread bandwidth(int threads) {
  constexpr std::size_t n = std::size_t{1} << 25;
  constexpr int rounds = 7;
  std::vector<double> a(n, 0.0), b(n, 1.0), c(n, 2.0), rates;
  for (int i = 0; i <= rounds; ++i) {
    const double t = seconds([&] {
      std::vector<std::thread> team;
      for (int k = 0; k < threads; ++k) {
        team.emplace_back([&, k] {
          const std::size_t share = n / static_cast<std::size_t>(threads), from = share * static_cast<std::size_t>(k);
          for (std::size_t j = from; j < from + share; ++j) a[j] = b[j] + 3.0 * c[j];
        });
      }
      for (std::thread& thread : team) thread.join();
    });
    if (i > 0) rates.push_back(3.0 * sizeof(double) * static_cast<double>(n) / t);
  }
  if (a[n / 2] != 7.0) std::exit(1);
  return spread_of(rates);
}

void print(const char* name, const Spread& s) {
  std::printf(", \"%s\": %.6g, \"%s_low\": %.6g, \"%s_high\": %.6g", name, s.median / 1e9, name, s.low / 1e9, name,
              s.high / 1e9);
}

}  // namespace

int main(int, char** argv) {
  topple::solver::prepare_blas(argv);
  const int all = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  std::printf("{\"blas_kernel\": \"%s\", \"processors\": %d", topple::solver::blas_kernel().c_str(), all);
  print("product_gflops", product_rate(1));
  print("product_gflops_all", product_rate(all));
  print("bandwidth_gbytes", bandwidth(1));
  print("bandwidth_gbytes_all", bandwidth(all));
  std::printf("}\n");
  return 0;
}
