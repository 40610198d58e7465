// Numbers come in through one door, and what is no number never does.
#include "topple/structure/number_range.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "topple/structure/error.h"
#include "topple/structure/joint_check.h"

using namespace topple::structure;

TEST_CASE("a text is a number only as a whole, finite, decimal one") {
  for (const char* text :
       {"nan", "-nan", "NaN", "inf", "-inf", "infinity", "1e400", "-1e400", "",      " ",   "+",
        "-",   "0x10", "1 ",  " 1",  "1,5",  "1e",       "--1",   "+-1",    "1.5.2", "ten", "\xD9\xA1"})
    CHECK_FALSE(number_of(text));
  CHECK(number_of("0") == 0.0);
  CHECK(number_of("+1.5") == 1.5);
  CHECK(number_of("-2.5e-3") == -2.5e-3);
  CHECK(std::signbit(*number_of("-0")));
}

TEST_CASE("no range holds what is no number, nor what is infinite") {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  for (const NumberRange& range : {ranges::anything, ranges::step, ranges::duration, ranges::place, ranges::sudden,
                                   NumberRange{-1e308, 1e308, true}}) {
    CHECK_FALSE(range.contains(nan));
    CHECK_FALSE(range.contains(unlimited));
    CHECK_FALSE(range.contains(-unlimited));
    CHECK_THROWS_AS(require_in(range, nan, "it"), InputError);
  }
  CHECK(NumberRange{0, 1}.contains(0));
  CHECK(NumberRange{0, 1}.contains(-0.0));
  CHECK_FALSE(NumberRange{0, 1, true}.contains(-0.0));
  CHECK_THROWS_WITH(require_in({0, 1, true}, 2, "share"), "share: found 2; accepted: a number above 0, at most 1");
  CHECK_THROWS_WITH(require_in({1, 10}, nan, "--sudden"), "--sudden: found nan; accepted: a number from 1 to 10");
}

TEST_CASE("a demand that is no number is more than any joint bears") {
  JointCapacity capacity;
  capacity.breakable = true;
  capacity.value.fill(1e6);
  for (const Interaction interaction : {Interaction::max, Interaction::sum})
    for (int component = 0; component < 6; ++component)
      for (const double value : {std::numeric_limits<double>::quiet_NaN(), unlimited, -unlimited}) {
        capacity.interaction = interaction;
        Vec6 demand = Vec6::Constant(1);
        demand(component) = value;
        CHECK_FALSE(utilisation(capacity, demand).value <= 1);
      }
  CHECK_FALSE(utilisation(capacity, Vec6::Constant(1), std::numeric_limits<double>::quiet_NaN()).value <= 1);
}
