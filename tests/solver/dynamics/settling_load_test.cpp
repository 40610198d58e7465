// A load that follows from the motion that it makes.
#include "dynamics/settling_load.h"

#include <catch2/catch.hpp>
#include <limits>

using namespace topple::solver;

namespace {

Eigen::VectorXd pair(double a, double b) { return Eigen::Vector2d(a, b); }

Eigen::VectorXd over(const SettlingLoad& load, double share_of_start) {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(2);
  load.add_to(share_of_start, sum);
  return sum;
}

}  // namespace

TEST_CASE("a load that follows from the motion is taken until it stays, and given up for that at the start") {
  SettlingLoad load;
  load.begin(pair(4, 8));
  CHECK(over(load, 0.25) == pair(4, 8));
  CHECK(load.iterate(pair(8, 0)) == SettlingLoad::Pass::open);
  CHECK(over(load, 0.25) == pair(7, 2));
  CHECK(load.iterate(pair(8, 1e-9)) == SettlingLoad::Pass::settled);
  CHECK(over(load, 0.25) == pair(7, 2));
  CHECK(load.iterate(pair(8, 1e-7)) == SettlingLoad::Pass::open);
  CHECK(load.iterate(pair(std::numeric_limits<double>::infinity(), 0)) == SettlingLoad::Pass::lost);
  load.give_up();
  CHECK(over(load, 0.25) == pair(4, 8));
}
