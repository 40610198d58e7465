// `connect`: what lies together is joined. Against closed forms and the same structure written out by hand.
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <string>

#include "topple/structure/analysis.h"
#include "topple/structure/error.h"
#include "topple/structure/formats/convert.h"
#include "topple/structure/formats/files.h"
#include "topple/structure/modelling_checks.h"

using namespace topple::structure;
using Catch::Matchers::Contains;

namespace {

std::string model(const std::string& nodes, const std::string& members, const std::string& rest) {
  return R"({"topple": 1, "materials": {"S": {"youngs_modulus": 210e9, "poisson_ratio": 0.3}},
    "sections": {"b": {"area": 0.01, "Iy": 1e-4, "Iz": 1e-4, "J": 1e-4}, "p": {"area": 1000, "Iy": 1e-4, "Iz": 1e-4, "J": 1e-4}},
    "nodes": {)" +
         nodes + R"(}, "members": {)" + members + "}, " + rest + "}";
}

std::string beam(const char* name, const char* from, const char* to, const char* section = "b", const char* more = "") {
  return std::string("\"") + name + R"(": {"nodes": [")" + from + R"(", ")" + to + R"("], "section": ")" + section +
         R"(", "material": "S")" + more + "}";
}

constexpr const char* two_spans = R"("A": [0, 0, 3], "B": [10, 0, 3], "foot": [5, 0, 0], "head": [5, 0, 3])";
const std::string held =
    R"("supports": {"A": {"x": true, "y": true, "z": true, "rx": true}, "B": {"y": true, "z": true}, "foot": "fixed"},)";

std::string propped(const std::string& connect) {
  return model(two_spans, beam("M", "A", "B") + ", " + beam("P", "foot", "head", "p"),
               held + connect + R"("loads": {"q": {"members": {"M": [{"uniform": {"z": -8000}}]}}})");
}

double vertical(const Building& b, const AnalysisResult& r, const std::string& node) {
  for (std::size_t i = 0; i < b.supports.size(); ++i)
    if (b[b.supports[i].node].name == node) return r.combinations[0].reactions[i](2);
  FAIL("no support " << node);
  return 0;
}

}  // namespace

TEST_CASE("connected, a post under a beam's middle carries five quarters of a span's load") {
  const Building alone = parse_model(propped(""), "m.json");
  CHECK(modelling_warnings(alone).size() == 1);
  CHECK(std::abs(vertical(alone, analyse(alone), "foot")) < 1e-6);  // nothing rests on it

  const Building joined = parse_model(propped(R"("connect": true, )"), "m.json");
  CHECK(modelling_warnings(joined).empty());
  REQUIRE(joined.members.size() == 3);
  CHECK(joined.members[2].name == "M/2");
  CHECK(joined.members[0].length == 5);
  const AnalysisResult result = analyse(joined);
  // Two spans of 5 m: 1.25 q l. The post of 1000 m2 gives way by 2e-8 of what the beam would.
  CHECK(vertical(joined, result, "foot") == Approx(1.25 * 8000 * 5).epsilon(1e-6));
  CHECK(vertical(joined, result, "A") == Approx(0.375 * 8000 * 5).epsilon(1e-6));
}

TEST_CASE("connected nodes half a millimetre apart are one, with what hangs on them") {
  const std::string nodes = R"("A": [0, 0, 0], "B": [4, 0, 0], "C": [4.0005, 0, 0], "D": [8, 0, 0])";
  const std::string members = beam("one", "A", "B") + ", " + beam("two", "C", "D");
  const std::string rest =
      R"("supports": {"A": "fixed"}, "connect": 0.001, "loads": {"P": {"nodes": {"D": {"z": -1000}, "C": {"y": 500}}}})";
  const Building b = parse_model(model(nodes, members, rest), "m.json");
  REQUIRE(b.nodes.size() == 3);
  CHECK(b.members[1].length == Approx(4).epsilon(1e-14));
  const AnalysisResult r = analyse(b);
  // A cantilever of 8 m: P l^3/(3 E I), and the load at its middle, a^2 (3 l - a)/(6 E I).
  CHECK(r.combinations[0].displacements[2](2) == Approx(-1000 * 512 / (3 * 210e9 * 1e-4)).epsilon(1e-10));
  CHECK(r.combinations[0].displacements[2](1) == Approx(500 * 16 * 20 / (6 * 210e9 * 1e-4)).epsilon(1e-10));
}

TEST_CASE("a divided member keeps its loads, ends and effective lengths") {
  const std::string nodes = R"("A": [0, 0, 3], "B": [9, 0, 3], "N1": [3, 0, 3], "N2": [5, 0, 3], "F": [5, 0, 0])";
  const std::string members = beam("M", "A", "B", "b", R"(, "design": {"factor_z": 0.5, "restraints": [1, 4, 8]})") +
                              ", " + beam("P", "F", "N2") + ", " + beam("Q", "F", "N1");
  const std::string rest =
      R"("supports": {"A": "fixed", "B": "fixed", "F": "fixed"}, "connect": true, "loads": {"L": {"members": {"M": [
        {"trapezoid": {"z": [-1000, -4000]}, "from": 1.0, "to": 7.0}, {"point": {"y": 2000}, "at": 5}]}}})";
  const Building b = parse_model(model(nodes, members, rest), "m.json");
  REQUIRE(b.members.size() == 5);
  CHECK(b.members[3].name == "M/2");
  CHECK(b.members[4].name == "M/3");
  CHECK(b.members[4].length == Approx(4).epsilon(1e-14));
  for (const std::size_t m : {std::size_t{0}, std::size_t{3}, std::size_t{4}}) {
    CHECK(*b.members[m].design.lengths[1] == Approx(4.5).epsilon(1e-14));
    CHECK(b.members[m].design.restraints.size() == 1);
  }
  CHECK(b.members[4].design.restraints[0] == Approx(3).epsilon(1e-14));  // at 8 m of the whole, 5 m before the piece
  Vec6 sum = Vec6::Zero();
  const AnalysisResult result = analyse(b);
  for (const Vec6& reaction : result.combinations[0].reactions) sum += reaction;
  CHECK(sum(2) == Approx(6 * 2500).epsilon(1e-10));  // the trapezoid's area
  CHECK(sum(1) == Approx(-2000).epsilon(1e-10));
}

TEST_CASE("ties stay whole, and what is shorter than the tolerance cannot be connected") {
  const Building b = parse_model(
      model(two_spans, beam("M", "A", "B", "b", R"(, "axial": "tension")") + ", " + beam("P", "foot", "head", "p"),
            held + R"("connect": true, "loads": {"w": {"self_weight": 1}})"),
      "m.json");
  CHECK(b.members.size() == 2);
  CHECK(modelling_warnings(b).size() == 1);
  const std::string nodes = R"("A": [0, 0, 0], "B": [0.5, 0, 0], "C": [4, 0, 0])";
  const std::string members = beam("one", "A", "B") + ", " + beam("two", "B", "C");
  CHECK_THROWS_WITH(parse_model(model(nodes, members, R"("supports": {"A": "fixed"}, "connect": 0.6)"), "m.json"),
                    Contains("member one") && Contains("tolerance of `connect`"));
  CHECK_THROWS_WITH(parse_model(model(nodes, members, R"("supports": {"A": "fixed"}, "connect": "yes")"), "m.json"),
                    Contains("connect") && Contains("true, false, or a length"));
}

// Two spans of 5 m under 8 kN/m on a stiff post: 5 q L/4 = 50 kN on the post.
TEST_CASE("a model that is converted with --join bears as one whose parts are joined") {
  const auto folder = std::filesystem::temp_directory_path() / "topple_joined_test";
  std::filesystem::create_directories(folder);
  const auto file = folder / "apart.json";
  std::ofstream(file) << propped("");
  const JoinedModel joined = joined_model(file, 0.001);
  CHECK(joined.members_divided == 1);
  CHECK(joined.nodes_merged == 0);
  const Building building = parse_model(joined.text, "joined.json");
  CHECK(vertical(building, analyse(building), "foot") == Approx(50e3).epsilon(1e-3));
  CHECK_THROWS_WITH(joined_model(file, 0), Contains("above 0"));
  std::ofstream(file) << joined.text;
  CHECK_THROWS_WITH(joined_model(file, 0.001), Contains("`connect` itself"));
  std::filesystem::remove_all(folder);
}
