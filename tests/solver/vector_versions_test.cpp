// Eight lanes in one vector, in two and in four: what processors of different vectors compute has the same bits.
#include "factor/vector_versions.h"

#include <catch2/catch.hpp>
#include <vector>

#include "random_values.h"

using namespace topple::solver;
using topple::test::random_values;

namespace {

constexpr int rows = 31;

/// Every operation that lanes have, over rows that end with less than eight.
template <class Eight>
std::vector<double> all_operations(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> result(rows);
  each_lanes<Eight>(rows, [&]([[maybe_unused]] auto lanes, int i) {
    using Lanes = decltype(lanes);
    using Vector = typename Lanes::Vector;
    const Vector x = lanes_at<Lanes>(a.data() + i), y = lanes_at<Lanes>(b.data() + i);
    Vector sum = x * y;
    sum += 3.7 * x;
    sum -= y * a[0];
    sum = sum + (x - y) * (-y);
    add_magnitude(x, sum);
    lanes_at<Lanes>(result.data() + i) = sum;
  });
  return result;
}

}  // namespace

TEST_CASE("eight lanes have the same bits in one vector, two and four") {
  const std::vector<double> a = random_values(rows, 1), b = random_values(rows, 2);
  const std::vector<double> expected = [&] {
    std::vector<double> one_by_one(rows);
    for (std::size_t i = 0; i < rows; ++i) {
      double sum = a[i] * b[i];
      sum += 3.7 * a[i];
      sum -= b[i] * a[0];
      sum = sum + (a[i] - b[i]) * -b[i];
      sum += a[i] < 0 ? -a[i] : a[i];
      one_by_one[i] = sum;
    }
    return one_by_one;
  }();
  CHECK(all_operations<EightLanes>(a, b) == expected);
  CHECK(all_operations<Twice<FourLanes>>(a, b) == expected);
  CHECK(all_operations<Twice<Twice<TwoLanes>>>(a, b) == expected);
}

TEST_CASE("constants that index an array come in order, each once") {
  std::vector<int> seen;
  each_constant<5>([&](auto k) {
    static_assert(k < 5);
    seen.push_back(k);
  });
  CHECK(seen == std::vector<int>{0, 1, 2, 3, 4});
  each_constant<0>([&](auto k) { seen.push_back(k); });
  CHECK(seen.size() == 5);
}
