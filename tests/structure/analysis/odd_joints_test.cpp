// Warnings of strong and weak axes that do not go together: told where they are most likely exchanged, and nowhere
// else.
#include <algorithm>
#include <catch2/catch.hpp>

#include "topple/structure/formats/files.h"
#include "topple/structure/modelling_checks.h"

using namespace topple::structure;

namespace {

/// Two IPE 300 in one line of 5 m each along z, with a joint at the foot.
std::vector<std::string> warnings_of(const std::string& joint, const std::string& top = "0, 0, 10",
                                     const std::string& upper = "") {
  return modelling_warnings(parse_model(R"({"topple": 1,
    "materials": {"s": {"youngs_modulus": 2.1e11, "poisson_ratio": 0.3, "density": 7850, "yield_strength": 235e6}},
    "sections": {"col": {"catalogue": "IPE300"}}, "joints": {"foot": )" +
                                            joint + R"(}, "nodes": {"A": [0, 0, 0], "B": [0, 0, 5], "C": [)" + top +
                                            R"(]}, "supports": {"A": "fixed"}, "members": {
      "AB": {"kind": "post", "nodes": ["A", "B"], "section": "col", "material": "s", "joints": ["foot", null]},
      "BC": {"kind": "post", "nodes": ["B", "C"], "section": "col", "material": "s")" +
                                            upper + R"(}}, "loads": {"g": {"self_weight": 1}}})",
                                        "posts.json"));
}

bool told(const std::vector<std::string>& warnings, const std::string& words) {
  return std::any_of(warnings.begin(), warnings.end(),
                     [&](const std::string& warning) { return warning.find(words) != std::string::npos; });
}

}  // namespace

TEST_CASE("a joint that is stronger or stiffer about its section's weak axis is told") {
  CHECK(told(warnings_of(R"({"capacity": {"moment_y": 3e4, "moment_z": 1.2e5}})"),
             "joint AB:1 has a moment_z of 4 times its moment_y (section col, stronger about y)"));
  CHECK(told(warnings_of(R"({"stiffness": {"ry": 1e6, "rz": 2e7}})"),
             "joint AB:1 has a stiffness rz of 20 times its ry"));
  for (const char* meant :
       {R"({"capacity": {"moment_y": 1.2e5, "moment_z": 3e4}})", R"({"capacity": {"moment_y": 1e5, "moment_z": 1e5}})",
        R"({"capacity": {"from": "section", "ratio": 0.5}})", R"({"stiffness": {"ry": 0, "rz": 0}})",
        R"({"stiffness": {"ry": 0}})", R"({"stiffness": {"ry": 2e7}})", R"({"capacity": {"moment_z": 3e4}})"})
    CHECK_FALSE(told(warnings_of(meant), "joint AB:1"));
}

TEST_CASE("a member that lies on its side in the line of another is told") {
  const std::string joint = R"({"stiffness": {}})";
  CHECK_FALSE(told(warnings_of(joint), "in one line"));
  CHECK(told(warnings_of(joint, "0, 0, 10", R"(, "up": [0, 1, 0])"),
             "members AB and BC go on in one line, turned by 90 degrees"));
  // Out of plumb by 1 mm in 5 m: its `up` is global z, no longer global x, and its web turns with the lean.
  CHECK(told(warnings_of(joint, "0, 0.001, 10"), "turned by 90 degrees"));
  CHECK_FALSE(told(warnings_of(joint, "0, 0.001, 10", R"(, "up": [1, 0, 0])"), "in one line"));
  CHECK_FALSE(told(warnings_of(joint, "0, 3, 9", R"(, "up": [0, 1, 0])"), "in one line"));  // a bend is no line
}
