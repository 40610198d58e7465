// What a study of files names: members, joints, places in the files, options of the analysis.
#include <catch2/catch.hpp>
#include <fstream>

#include "study/analysis_options.h"
#include "study/study_base.h"
#include "support/scratch_folder.h"
#include "topple/structure/error.h"
#include "topple/structure/formats/files.h"
#include "topple/structure/study/study.h"

using namespace topple::structure;
using namespace topple::structure::study;

namespace {

constexpr const char* bay = R"({"topple": 1, "title": "a/b~c",
 "materials": {"S": {"youngs_modulus": 210e9, "poisson_ratio": 0.3, "density": 7850}},
 "sections": {"tube": {"shape": "box", "depth": 0.3, "width": 0.3, "thickness": 0.015}},
 "joints": {"j": {"capacity": {"force": [1e8, 1e8, 1e8], "moment": [1e8, 1e8, 1e8]}}},
 "nodes": {"A": [0, 0, 0], "B": [0, 0, 4], "C": [6, 0, 4], "D": [6, 0, 0], "E/F~": [3, 0, 0]},
 "members": {"P": {"kind": "post", "nodes": ["A", "B"], "section": "tube", "material": "S"},
             "Q": {"kind": "post", "nodes": ["D", "C"], "section": "tube", "material": "S"},
             "T": {"nodes": ["B", "C"], "section": "tube", "material": "S", "joints": ["j", "j"]},
             "U": {"nodes": ["E/F~", "C"], "section": "tube", "material": "S"}},
 "supports": {"A": "fixed", "D": "fixed", "E/F~": "fixed"},
 "loads": {"dead": {"self_weight": 1.0}, "live": {"nodes": {"B": {"x": 1000}}}},
 "combinations": {"all": {"dead": 1.35, "live": 1.5}, "collapse": {"dead": 1}}})";

class Place {
 public:
  Place() { std::ofstream(folder_ / "bay.json") << bay; }
  [[nodiscard]] Study study(const std::string& vary, const std::string& analyse = "[]",
                            const std::string& more = "") const {
    return parse_study(R"({"topple": 1, "base": {"model": "bay.json", "analyse": )" + analyse + R"(}, "vary": [)" +
                           vary + R"(], "record": {"use": "largest_use"}, "samples": 1)" + more + "}",
                       "t.json", folder_.path());
  }
  [[nodiscard]] std::string refusal(const std::string& vary, const std::string& analyse = "[]",
                                    const std::string& more = "") const {
    try {
      (void)study_task(study(vary, analyse, more));
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  }

 private:
  topple::test::ScratchFolder folder_;
};

constexpr const char* steel = R"({"name": "E", "at": "/materials/S/youngs_modulus", "uniform": [200e9, 220e9]})";

}  // namespace

TEST_CASE("the options of a study's analysis are those of the command, each with its value") {
  const Place place;
  const auto analysis = [&](const std::string& options) {
    const Study study = place.study(steel, options);
    return analysis_of(study, read_model(study.model));
  };
  const AnalysisOfSample all = analysis(
      R"(["--combination=coll*", "--p-delta", "--buckling", "2", "--modes=3", "--lose", "T", "--lose-each", "posts", "--sudden", "1.5", "--code", "en1993"])");
  REQUIRE(all.request.combinations.size() == 1);
  CHECK(all.request.combinations[0].index == 1);
  CHECK(all.request.second_order == topple::solver::SecondOrder::exact);
  CHECK(all.request.buckling == 2);
  CHECK(all.request.modes == 3);
  REQUIRE(all.request.losses.named.size() == 1);
  CHECK(all.request.losses.named[0].index == 2);
  CHECK(all.request.losses.each.size() == 2);
  CHECK(all.request.losses.sudden == 1.5);
  CHECK(all.code == DesignCode::en1993);
  CHECK(all.request.critical_sections);
  CHECK(all.request.workers == 1);
  CHECK(analysis(R"(["--p-delta=cubic"])").request.second_order == topple::solver::SecondOrder::cubic);
  CHECK(analysis(R"(["--code=aisc360"])").code == DesignCode::aisc360);
  CHECK(analysis(R"(["--combination", "*"])").request.combinations.size() == 2);
}

TEST_CASE("options that an analysis of a study does not have are refused with those that it has") {
  const Place place;
  for (const auto& [options, said] : {
           std::pair{R"(["--p-delta=linear"])", "--p-delta, --p-delta=exact, --p-delta=cubic"},
           std::pair{R"(["--threads", "1"])", "\"--threads\"; accepted: --combination"},
           std::pair{R"(["--html"])", "\"--html\"; accepted: --combination"},
           std::pair{R"(["--modes"])", "\"--modes\"; accepted: a value behind it"},
           std::pair{R"(["--modes", "many"])", "\"--modes many\"; accepted: a number from 0 to 10000"},
           std::pair{R"(["--modes=nan"])", "\"--modes nan\""},
           std::pair{R"(["--buckling=-1"])", "\"--buckling -1\""},
           std::pair{R"(["--sudden", "0.5"])", "\"--sudden 0.5\""},
           std::pair{R"(["--lose", "X*"])", "a member's name or pattern"},
           std::pair{R"(["--lose-each", "nothing"])", "a group of members"},
           std::pair{R"(["--code", "bs5950"])", "en1993 or aisc360"},
           std::pair{R"(["--combination", "no*"])", "\"all\", \"collapse\""},
       }) {
    INFO(options);
    CHECK_THAT(place.refusal(steel, options), Catch::StartsWith("t.json, base.analyse: ") && Catch::Contains(said));
  }
}

TEST_CASE("pointers into a file follow RFC 6901, and those that lead nowhere are told what there is") {
  const Place place;
  const auto at = [&](const std::string& pointer, const std::string& rest = R"("uniform": [0, 1])") {
    return place.refusal(R"({"name": "v", "at": ")" + pointer + "\", " + rest + "}");
  };
  CHECK(at("/nodes/E~1F~0/0") == "no error");
  CHECK(at("/nodes/A/1", R"("add": true, "uniform": [0, 0.1])") == "no error");
  CHECK(at("/materials/S/yield_strength") == "no error");  // left out of the file
  CHECK_THAT(at("/nodes/E~2F/0"), Catch::Contains("in which ~ is written ~0 and / in a name ~1"));
  CHECK_THAT(at("/nodes/E~"), Catch::Contains("in which ~ is written ~0 and / in a name ~1"));
  CHECK_THAT(at("/nodes/A/3"), Catch::Contains("bay.json has no \"3\"") && Catch::Contains("0 to 3 (without it)"));
  CHECK_THAT(at("/nodes/A/x"), Catch::Contains("bay.json has no \"x\""));
  CHECK_THAT(at("/nodes/A/"), Catch::Contains("bay.json has no \"\""));
  CHECK_THAT(at("/nodes/A/0/0"), Catch::Contains("a pointer that ends before it"));
  CHECK_THAT(at("/nothing/A"), Catch::Contains("no \"nothing\"") && Catch::Contains("\"materials\""));
  CHECK_THAT(at("/title", R"("add": true, "uniform": [0, 1])"),
             Catch::Contains("stands there in bay.json; accepted for \"add\" and \"times\": a number"));
}

TEST_CASE("numbers are put in, added and multiplied, and texts and lists take another's place") {
  VariedDocument document(R"({"a": [1, 2, {"b": 3}], "t": "x"})", "d.json");
  const auto target = [&](const char* pointer, Variation::Change change) {
    Variation variation;
    variation.pointer = pointer;
    variation.change = change;
    variation.place = "t.json, vary.0";
    return document.add_target(variation);
  };
  CHECK(target("/a/1", Variation::Change::add) == 0);
  CHECK(target("/a/2/b", Variation::Change::times) == 1);
  const StudyValue two{2, ""}, four{4, ""};
  for (int i = 0; i < 2; ++i) {  // from what stands in the file each time
    const auto& root = document.with({&two, &four});
    CHECK(value_at(root, "/a/1")->number() == 4);
    CHECK(value_at(root, "/a/2/b")->number() == 12);
  }
  CHECK(document.only_numbers());
  StudyValue list{0, "[5, 6]"};
  CHECK(target("/t", Variation::Change::replace) == 2);
  CHECK_FALSE(document.only_numbers());
  const auto& root = document.with({&two, &four, &list});
  CHECK(value_at(root, "/t/1")->number() == 6);
  CHECK(value_at(root, "/a/1")->number() == 4);
  CHECK(value_at(root, "/a/2/b")->number() == 12);
  CHECK(value_at(root, "/a/0")->number() == 1);
  CHECK_FALSE(value_at(root, "/a/9").has_value());
  CHECK(document.pointers() == std::vector<std::string>{"/a/1", "/a/2/b", "/t"});
}

TEST_CASE("what varies by name goes to each or all of the parts that have it") {
  const Place place;
  const auto base = [&](const std::string& vary) {
    const Study study = place.study(vary);
    return make_base(study, study.vary);
  };
  const auto together = base(R"({"name": "s", "joints": "T:*", "strength": {"uniform": [0.8, 1.2]}})");
  REQUIRE(together->effects.size() == 1);
  CHECK(together->variables.size() == 1);
  CHECK(together->effects[0].names == std::vector<std::vector<std::string>>{{"T:1", "T:2"}});
  const auto each = base(R"({"name": "s", "joints": "T:*", "strength": {"uniform": [0.8, 1.2]}, "each": true})");
  REQUIRE(each->variables.size() == 2);
  CHECK(each->variables[1].name == "s T:2");
  CHECK(each->effect("s") == &each->effects[0]);
  CHECK(each->effect("t") == nullptr);
  const auto lost = base(R"({"name": "lost", "lose_each": "posts"})");
  CHECK(lost->effects[0].names == std::vector<std::vector<std::string>>{{"P", "Q"}});
}

TEST_CASE("names that a study's model does not have are refused with the place") {
  const Place place;
  CHECK_THAT(place.refusal(R"({"name": "lost", "lose_each": "X*"})"),
             Catch::Contains("lose_each: there is no member or group \"X*\""));
  CHECK_THAT(place.refusal(R"({"name": "s", "joints": "nothing", "strength": {"uniform": [0.8, 1.2]}})"),
             Catch::Contains(".joints: ") && Catch::Contains("nothing"));
  CHECK_THAT(place.refusal(R"({"name": "s", "joints": "P:1", "strength": {"uniform": [0.8, 1.2]}})"),
             Catch::Contains(".joints: none of \"P:1\" has a capacity; accepted: joints that can break"));
}

TEST_CASE("a group of correlated entries needs entries of chance, and a matrix of their size") {
  const Place place;
  const std::string two = std::string(steel) + R"(, {"name": "x", "at": "/nodes/C/0", "uniform": [5, 6]})";
  const Study study = place.study(two, "[]", R"(, "groups": [{"of": ["E", "x"], "correlation": 0.5}])");
  CHECK(make_base(study, study.vary)->groups[0].correlation == std::vector<double>{1, 0.5, 0.5, 1});
  const std::string grid = std::string(steel) + R"(, {"name": "x", "at": "/nodes/C/0", "grid": [5, 6]})";
  CHECK_THAT(place.refusal(grid, "[]", R"(, "groups": [{"of": ["E", "x"], "correlation": 0.5}])"),
             Catch::Contains("\"x\" is a grid, which goes through all its values"));
  const std::string each =
      std::string(steel) + R"(, {"name": "s", "joints": "T:*", "strength": {"uniform": [0.8, 1.2]}, "each": true})";
  CHECK_THAT(place.refusal(each, "[]", R"(, "groups": [{"of": ["E", "s"], "correlation": [[1, 0.5], [0.5, 1]]}])"),
             Catch::Contains("a matrix for entries of 3 variables"));
}
