#pragma once
// Numbers by chance for tests of kernels.
#include <random>
#include <vector>

namespace topple::test {

/// Between -1 and 1, the same for the same seed.
[[nodiscard]] inline std::vector<double> random_values(std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> value(-1, 1);
  std::vector<double> values(count);
  for (double& v : values) v = value(random);
  return values;
}

}  // namespace topple::test
