// The iteration for second order by itself, on answers that the test makes.
#include "standing/statics/displaced_rest.h"

#include <catch2/catch.hpp>
#include <cmath>

using namespace topple;
using namespace topple::structure;

namespace {

std::vector<Vec6> of(double value) { return {Vec6(Vec6::Constant(value))}; }

}  // namespace

TEST_CASE("a rest that geometric forces keep growing is given up while its numbers are numbers", "[second order]") {
  // Forces and displacements multiply, and more so where members turn: each answer is as the cube of the one before.
  const double first = GENERATE(0.1, 1.0, 50.0);
  std::vector<Vec6> last;
  const auto answer = [&](const std::vector<Vec6>& at) {
    CHECK(at.front().allFinite());
    last = of(1e4 * std::pow(at.front()(0), 3) + first);
    CHECK(last.front().allFinite());
    return &last;
  };
  CHECK(find_displaced_rest(of(first), answer) == DisplacedRest::none);
}

TEST_CASE("a rest near the critical load is found, by so much of the forces' share that it grows far",
          "[second order]") {
  const double share = GENERATE(0.1, 0.9, 0.99);
  std::vector<Vec6> last;
  const auto answer = [&](const std::vector<Vec6>& at) {
    last = of(share * at.front()(0) + 1e-3);
    return &last;
  };
  CHECK(find_displaced_rest(of(1e-3), answer) == DisplacedRest::found);
  CHECK(last.front()(0) == Approx(1e-3 / (1 - share)).epsilon(1e-6));
}
