// Whatever the file holds, the reader gives a building or one clear line: it neither crashes nor takes in nonsense.
#include <catch2/catch.hpp>
#include <random>

#include "example_model.h"
#include "mutation.h"
#include "topple/structure/error.h"
#include "topple/structure/files.h"

using namespace topple::structure;
using topple::test::example_model;

namespace {

const std::string generator_model = R"({"topple": 1, "materials": {"m": {"youngs_modulus": 2e11, "poisson_ratio": 0.3}},
  "sections": {"s": {"shape": "box", "depth": 0.3, "width": 0.2, "thickness": 0.01}},
  "loads": {"dead": {"self_weight": 1}},
  "building": {"name": "A", "posts": [2, 3], "storeys": 2, "bay": [6, [5, 6]], "storey_height": [4, 3], "omit": ["P-1-2-*"],
    "post": [{"storeys": [1, 2], "section": "s", "material": "m"}], "beam": {"section": "s", "material": "m", "groups": ["g"]},
    "slab": {"thickness": 0.2, "material": "m", "pressure": {"dead": 1000}},
    "wall": {"thickness": 0.1, "material": "m", "sides": ["x-", "y2"]}}})";

/// One random change: a character, a piece moved over another, a piece dropped, a number made extreme.
std::string mutated(std::string text, std::mt19937& random) {
  const auto below = [&](std::size_t n) { return static_cast<std::size_t>(random() % n); };
  static const char alphabet[] = "{}[]\",:0123456789.-eE+ntfxyz*\\/ \n";
  static const char* const values[] = {"0",    "-1",        "1e308",  "-1e308", "1e-308", "null",
                                       "true", "\"fixed\"", "[]",     "{}",     "\"\"",   "[0,0,0]",
                                       "1e9",  "0.5",       "\"A0\"", "2",      "[1,2]",  "\"I\""};
  switch (below(5)) {
    case 0:
      text[below(text.size())] = alphabet[below(sizeof alphabet - 1)];
      break;
    case 1:
      text.erase(below(text.size()), below(30));
      break;
    case 2:
      text.insert(below(text.size()), text.substr(below(text.size()), below(60)));
      break;
    default: {  // the value after some colon or comma
      const std::size_t at = text.find_first_of(":,", below(text.size()));
      if (at == std::string::npos) break;
      const std::size_t end = text.find_first_of(",}]", at + 1);
      if (end == std::string::npos) break;
      text.replace(at + 1, end - at - 1, values[below(std::size(values))]);
    }
  }
  return text;
}

void check_sound(const Building& building) {
  for (const Member& member : building.members) {
    REQUIRE(member.length > 0);
    REQUIRE(std::isfinite(member.length));
    REQUIRE((member.axes * member.axes.transpose() - Mat3::Identity()).norm() < 1e-9);
  }
  for (const Node& node : building.nodes) REQUIRE(node.position.allFinite());
  for (const Section& section : building.sections) REQUIRE((section.area > 0 && section.J > 0));
  for (const Panel& panel : building.panels) REQUIRE(panel.thickness > 0);
  REQUIRE_FALSE(building.combinations.empty());
  REQUIRE(building.joints.size() == 2 * building.members.size() + 4 * building.panels.size());
}

}  // namespace

TEST_CASE("mutated models give a sound building or one clear line") {
  std::mt19937 random(20240229);
  int accepted = 0, refused = 0;
  for (int round = 0; round < topple::test::fuzz_rounds; ++round) {
    std::string text = round % 2 == 0 ? example_model : generator_model;
    for (std::size_t changes = 1 + random() % 3; changes > 0; --changes) text = mutated(std::move(text), random);
    INFO(text);
    try {
      check_sound(parse_model(text, "m.json", Purpose::inspect));
      ++accepted;
    } catch (const InputError& error) {
      const std::string what = error.what();
      REQUIRE(what.starts_with("m.json, line "));
      REQUIRE(what.find('\n') == std::string::npos);
      ++refused;
    }
  }
  CHECK(accepted > 10);  // the changes reach behind the syntax
  CHECK(refused > 100);
}
