// Charges as inputs of a study: which go off, and when.
#include <catch2/catch.hpp>

#include "study/study_base.h"
#include "topple/structure/study/study.h"

using namespace topple::structure;
using namespace topple::structure::study;

namespace {

std::shared_ptr<const StudyBase> base_of(const std::string& charges) {
  const Study study = parse_study(R"({"topple": 1, "base": {"scenario": "tower_charges"}, "samples": 1, "vary": [)" +
                                      charges + R"(], "record": {"down": "share_down"}})",
                                  "study", {});
  return make_base(study, study.vary);
}

}  // namespace

TEST_CASE("Charges that go off together have one time and one choice, and each member counts as a charge") {
  const auto base = base_of(
      R"({"charges": ["P-1-1-1", "P-1-3-1"], "together": true, "when": {"uniform": [0, 2]}, "used": {"choice": [true, false]}})");
  REQUIRE(base->variables.size() == 2);
  BaseOfSample sample(base);
  sample.apply({{1.25, ""}, {0, "true"}});
  CHECK(sample.charges() == 2);
  REQUIRE(sample.scenario().events.size() == 1);
  CHECK(sample.scenario().events[0].at == 1.25);
  CHECK(std::get<RemoveTool>(sample.scenario().events[0].tool).members.size() == 2);
  BaseOfSample unused(base);
  unused.apply({{1.25, ""}, {0, "false"}});
  CHECK(unused.charges() == 0);
  CHECK(unused.scenario().events.empty());
}

TEST_CASE("A charge that two patterns name goes off once") {
  const auto base = base_of(R"({"charges": ["P-1-1-1", "P-1-*-1"], "when": {"uniform": [0, 2]}})");
  REQUIRE(base->variables.size() == 3);
  BaseOfSample sample(base);
  sample.apply({{0.5, ""}, {1, ""}, {1.5, ""}});
  CHECK(sample.charges() == 3);
  CHECK(sample.scenario().events.size() == 3);
}
