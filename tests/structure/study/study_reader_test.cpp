// Studies that contradict themselves are refused with the place and what is accepted.
#include <catch2/catch.hpp>

#include "topple/structure/error.h"
#include "topple/structure/study/study.h"

using namespace topple::structure;

namespace {

constexpr const char* of_model =
    R"({"topple": 1, "base": {"model": "wall", "analyse": ["--threads", "1"]}, "samples": 4,
  "vary": [{"name": "a", "at": "/nodes/A/0", "uniform": [0, 1]}, {"name": "b", "at": "/nodes/B/0", "uniform": [0, 1]}],
  "groups": [{"of": ["a", "b"], "correlation": [[1, 0.5], [0.5, 1]]}],
  "record": {"use": "largest_use", "there": "results:/combinations"}, "collapse_if": {"use": {"above": 1}}})";
constexpr const char* of_scenario = R"({"topple": 1, "base": {"scenario": "tower_charges"}, "samples": 4,
  "vary": [{"name": "charge", "charges": ["P-1-*"], "when": {"uniform": [0, 2]}, "used": {"choice": [true, false]}}],
  "record": {"down": "summary:/members"},
  "optimise": {"least": "down", "runs": 20, "repeats": 2, "unseen": 3, "method": "random", "subject_to": {"down": {"below": 9}}}})";

std::string refusal(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  REQUIRE(at != std::string::npos);
  text.replace(at, from.size(), to);
  try {
    (void)parse_study(text, "t.json", {});
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

}  // namespace

TEST_CASE("a study takes a matrix of correlations, a pointer into results, charges that may be left out and a goal") {
  const Study model = parse_study(of_model, "t.json", {});
  REQUIRE(model.groups.size() == 1);
  CHECK(model.groups[0].matrix == std::vector<double>{1, 0.5, 0.5, 1});
  REQUIRE(model.record.size() == 2);
  CHECK(model.record[1].pointer == "/combinations");
  const Study scenario = parse_study(of_scenario, "t.json", {});
  REQUIRE(scenario.optimise);
  CHECK(scenario.optimise->runs == 20);
  CHECK_FALSE(scenario.optimise->greatest);
  REQUIRE(scenario.optimise->choose.size() == 1);
  CHECK(scenario.optimise->choose[0].charges == std::vector<std::string>{"P-1-*"});
  CHECK(scenario.vary.empty());
}

TEST_CASE("what a study cannot mean is refused") {
  struct Change {
    const char *text, *from, *to, *said;
  };
  for (const auto& [text, from, to, said] : {
           Change{of_model, R"("wall")", R"("no such model")", "no such model"},
           Change{of_model, R"("samples": 4)", R"("samples": 0)", "accepted"},
           Change{of_model, R"("name": "b")", R"("name": "a")", "another entry is called"},
           Change{of_model, R"("name": "b")", R"("name": "")", "the name is empty"},
           Change{of_model, R"("/nodes/B/0", "uniform": [0, 1])", R"("/nodes/B/0")", "accepted"},
           Change{of_model, R"("/nodes/B/0")", R"("nodes")", "a JSON pointer, which begins with /"},
           Change{of_model, R"("/nodes/B/0", "uniform")", R"("/nodes/B/0", "sort": 1, "uniform")", "unknown key"},
           Change{of_model, R"("/nodes/B/0", "uniform")", R"("/nodes/B/0", "add": true, "times": true, "uniform")",
                  "both"},
           Change{of_model, R"("/nodes/B/0", "uniform": [0, 1])", R"("/nodes/B/0", "add": true, "choice": ["x", 1])",
                  "cannot be added"},
           Change{of_model, R"({"name": "b", "at": "/nodes/B/0", "uniform": [0, 1]})", R"({"name": "b"})",
                  "what varies is missing"},
           Change{of_model, R"("of": ["a", "b"])", R"("of": ["a", "c"])", "there is no entry \"c\""},
           Change{of_model, R"("of": ["a", "b"])", R"("of": ["a", "a"])", "it is in a group already"},
           Change{of_model, "[0.5, 1]]", "[0.4, 1]]", "a symmetric matrix"},
           Change{of_model, "[[1, 0.5]", "[[2, 0.5]", "accepted"},
           Change{of_model, R"("results:/combinations")", R"("results:")", "a JSON pointer behind the colon"},
           Change{of_model, R"("results:/combinations")", R"("summary:/x")", "a scenario as base"},
           Change{of_model, R"("largest_use")", R"("largest_of_all")", "one of"},
           Change{of_model, R"({"use": {"above": 1}})", R"({"nothing": {"above": 1}})",
                  "there is no output \"nothing\""},
           Change{of_model, R"({"above": 1})", R"({"above": 1, "below": 0})", "both in this order"},
           Change{of_model, R"({"model": "wall",)", R"({"scenario": "wall_hit",)", "a scenario is not analysed"},
           Change{of_model,
                  R"({"use": "largest_use", "there": "results:/combinations"}, "collapse_if": {"use": {"above": 1}})",
                  "{}", "nothing is recorded"},
           Change{of_scenario, R"("summary:/members")", R"("results:/x")", "a model as base"},

           Change{of_scenario, R"({"uniform": [0, 2]})", R"({"choice": [-1, 2]})", "a time is"},
           Change{of_scenario, R"({"uniform": [0, 2]})", R"({"choice": ["x"]})", "accepted: numbers"},
           Change{of_scenario, "[true, false]", "[1, 2]", "true and false"},
           Change{of_scenario, R"({"choice": [true, false]})", R"({"uniform": [0, 1]})", "true and false"},
           Change{of_scenario, R"("random")", R"("luck")", "cross-entropy"},
           Change{of_scenario, R"("least": "down")", R"("least": "up")", "there is no output"},
           Change{of_scenario, R"("least": "down")", R"("least": "down", "greatest": "down")", "one of"},
       }) {
    CAPTURE(from, to);
    const std::string line = refusal(text, from, to);
    CHECK_THAT(line, Catch::Contains(said));
  }
}
