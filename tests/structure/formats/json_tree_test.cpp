#include "topple/structure/formats/json_tree.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <random>

#include "topple/structure/error.h"

namespace topple::structure {

TEST_CASE("a tree of braces is an object where all are pairs that begin with a text, else a list") {
  const JsonTree tree = {{"name", "x"}, {"at", {1, 2.0, 0.5}}, {"pairs", {"a", "b"}}, {"in", {{"deep", nullptr}}}};
  REQUIRE(tree.is_object());
  CHECK(tree.dump() == R"({"name":"x","at":[1,2.0,0.5],"pairs":["a","b"],"in":{"deep":null}})");
  CHECK(JsonTree::array({{"a", "b"}}).dump() == R"([["a","b"]])");
  CHECK(JsonTree::array().dump(1) == "[]");
  CHECK(JsonTree::object().dump(1) == "{}");
  CHECK(JsonTree({{"a", {1, 2}}, {"b", true}}).dump(2) == "{\n  \"a\": [\n    1,\n    2\n  ],\n  \"b\": true\n}");
}

TEST_CASE("what is put under a name stands in the order in which it came, once") {
  JsonTree tree;
  tree["z"] = 1;
  tree["a"] = std::vector<double>{1, 2};
  tree["z"] = "again";
  tree["list"].push_back(-7);
  tree["list"].push_back(std::uint64_t{18446744073709551615u});
  CHECK(tree.dump() == R"({"z":"again","a":[1.0,2.0],"list":[-7,18446744073709551615]})");
  CHECK(tree.size() == 3);
  CHECK(tree.find("b") == nullptr);
}

TEST_CASE("texts are written so that they read back, and bytes that are no text are replaced") {
  const std::string text = "a \"quoted\" \\ line\n\tend\x01 \xC3\xA4";
  const JsonTree back = JsonTree::parse(JsonTree({{"t", "plain"}}).dump());
  CHECK(back.find("t")->text() == "plain");
  CHECK(JsonTree(text).dump() == R"("a \"quoted\" \\ line\n\tend\u0001 )"
                                 "\xC3\xA4\"");
  CHECK(JsonTree(std::string("b\xE4y\xFF")).dump() == "\"b\xEF\xBF\xBDy\xEF\xBF\xBD\"");
}

TEST_CASE("numbers read back to the same bits, and what is none is null") {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> exponent(-90, 90), digits(-1, 1);
  for (int i = 0; i < 2000; ++i) {
    const double number = digits(random) * std::pow(10, exponent(random));
    const std::string text = JsonTree(number).dump();
    CHECK(std::strtod(text.c_str(), nullptr) == number);
    CHECK(JsonTree::parse(text).number() == number);
  }
  CHECK(JsonTree(std::numeric_limits<double>::infinity()).dump() == "null");
  CHECK(JsonTree(std::nan("")).dump() == "null");
  CHECK(JsonTree(1e15).dump() == "1e+15");
  CHECK(JsonTree(1e14).dump() == "100000000000000.0");
  CHECK(JsonTree::parse("[7, 7.5, -0.25e1]").dump() == "[7,7.5,-2.5]");
}

TEST_CASE("a text that is no JSON, or nests without end, is refused") {
  CHECK_THROWS_AS(JsonTree::parse("{\"a\": }"), InputError);
  CHECK_THROWS_AS(JsonTree::parse(std::string(100000, '[')), InputError);
}

}  // namespace topple::structure
