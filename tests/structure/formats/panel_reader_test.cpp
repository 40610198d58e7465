// Panel files: what they hold is read as it stands, what they cannot mean is refused with its place.
#include <catch2/catch.hpp>
#include <fstream>

#include "formats/json/json_document.h"
#include "formats/read_fracture.h"
#include "support/scratch_folder.h"
#include "topple/structure/error.h"
#include "topple/structure/formats/panel_file.h"

using namespace topple::structure;
namespace fracture = topple::fracture;

namespace {

constexpr const char* panel_text = R"({"topple": 1, "seed": 7,
  "panel": {"outline": [[0, 0], [3, 0], [3, 2], [0, 2]], "thickness": 0.2, "density": 2400,
            "openings": [[[1, 0.5], [1, 1.5], [2, 1.5], [2, 0.5]]]},
  "fracture": {"method": "local", "points": [4, 6], "length": [0.3, 0.6], "ring": 0.25},
  "hits": [{"at": [0.5, 1], "radius": 0.4}, {"at": [2.5, 1]}]})";

std::string changed(const std::string& from, const std::string& to) {
  std::string text = panel_text;
  const std::size_t at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

std::string refusal(const std::string& text) {
  try {
    (void)parse_panel(text, "p.json");
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace

TEST_CASE("a panel file is read in full, openings the same way round as the outline") {
  const PanelFile file = parse_panel(panel_text, "p.json");
  CHECK(fracture::area(file.shape.outline) == Approx(6));
  REQUIRE(file.shape.openings.size() == 1);
  CHECK(fracture::area(file.shape.openings[0]) == Approx(1));  // given clockwise
  CHECK(file.shape.thickness == 0.2);
  CHECK(file.density == 2400);
  CHECK(file.settings.seed == 7);
  CHECK(file.settings.method == fracture::Method::local);
  CHECK(file.settings.local.points[0] == 4);
  CHECK(file.settings.local.points[1] == 6);
  CHECK(file.settings.local.length[0] == 0.3);
  CHECK(file.settings.local.length[1] == 0.6);
  CHECK(file.settings.local.ring == 0.25);
  REQUIRE(file.hits.size() == 2);
  CHECK(file.hits[0].radius == 0.4);
  CHECK_FALSE(file.hits[1].radius.has_value());
}

TEST_CASE("each way of breaking has its own settings and a name") {
  for (const auto& [name, method] :
       {std::pair{"voronoi", fracture::Method::voronoi}, std::pair{"quadrilateral", fracture::Method::quadrilateral},
        std::pair{"local", fracture::Method::local}}) {
    const std::string more = method == fracture::Method::local ? "" : R"(, "cell": 0.5, "jitter": 0.25)";
    const PanelFile file =
        parse_panel(changed(R"({"method": "local", "points": [4, 6], "length": [0.3, 0.6], "ring": 0.25})",
                            "{\"method\": \"" + std::string(name) + "\"" + more + "}"),
                    "p.json");
    CHECK(file.settings.method == method);
    CHECK(formats::method_name(file.settings.method) == std::string(name));
    if (more.empty()) continue;
    CHECK(file.settings.cell == 0.5);
    CHECK(file.settings.jitter == 0.25);
  }
}

TEST_CASE("lengths of a way of breaking are in the units of the model that has it") {
  const auto document =
      formats::JsonDocument::from_text(R"({"method": "local", "length": [300, 600], "ring": 250})", "m.json");
  const fracture::PanelSettings settings = formats::read_fracture(document.root(), 1e-3);
  CHECK(settings.local.length[1] == Approx(0.6));
  CHECK(settings.local.ring == Approx(0.25));
}

TEST_CASE("what a panel file cannot mean is refused with its place and what is accepted") {
  struct Change {
    const char *from, *to, *said;
  };
  for (const auto& [from, to, said] : {
           Change{"\"topple\": 1", "\"topple\": 2", "topple"},
           Change{"\"seed\": 7", "\"seed\": -1", "seed"},
           Change{"\"seed\": 7", "\"colour\": 7", "colour: unknown key"},
           Change{"[0, 2]]", "[0.5, -1]]", "the polygon crosses or touches itself"},
           Change{"[0, 2]]", "[0, 2e6]]", "accepted"},
           Change{"[[0, 0], [3, 0], [3, 2], [0, 2]]", "[[0, 0], [3, 0]]", "panel.outline"},
           Change{"0.2,", "1e-5,", "panel.thickness"},
           Change{"2400", "-1", "panel.density"},
           Change{"[1, 1.5], [2, 1.5]", "[2, 1.5], [1, 1.5]", "panel.openings[0]"},
           Change{"[[[1, 0.5], [1, 1.5], [2, 1.5], [2, 0.5]]]", "[[[-1, -1], [-1, 3], [4, 3], [4, -1]]]",
                  "nothing of the panel is left"},
           Change{"\"local\"", "\"glass\"", "\"voronoi\", \"quadrilateral\" or \"local\""},
           Change{"\"method\": \"local\", ", "", "method"},
           Change{"[4, 6]", "[6, 4]", "the least number, then the greatest"},
           Change{"[4, 6]", "[2, 4]", "fracture.points"},
           Change{"[0.3, 0.6]", "[0.6, 0.3]", "the least length, then the greatest"},
           Change{"[0.3, 0.6]", "[0.001, 0.3]", "in m"},
           Change{"\"ring\": 0.25", "\"ring\": 2000", "fracture.ring"},
           Change{"\"ring\": 0.25", "\"cell\": 0.25", "fracture.cell: unknown key"},
           Change{"\"radius\": 0.4", "\"radius\": -1", "hits[0].radius"},
           Change{"\"at\": [2.5, 1]", "\"at\": [2.5]", "hits[1].at"},
           Change{"\"at\": [2.5, 1]", "\"at\": [2.5, 1e9]", "hits[1].at"},
           Change{"{\"at\": [2.5, 1]}", "{\"radius\": 1}", "hits[1]"},
           Change{"{\"at\": [2.5, 1]}",
                  "{\"at\": [1, 1], \"radius\": 999}, {\"at\": [2, 1], \"radius\": 999}, {\"at\": [2, 1], \"radius\": "
                  "999}",
                  "hits[3]: the hits so far may break out more"},
       }) {
    INFO(from << " -> " << to);
    CHECK_THAT(refusal(changed(from, to)), Catch::StartsWith("p.json") && Catch::Contains(said));
  }
}

TEST_CASE("cells of a grid need a convex quadrilateral, and as many as there is room for") {
  const std::string grid = R"("fracture": {"method": "quadrilateral", "cell": CELL}, "hits": HITS})";
  const auto with = [&](const std::string& outline, const std::string& cell, const std::string& hits) {
    std::string rest = grid;
    rest.replace(rest.find("HITS"), 4, hits);
    rest.replace(rest.find("CELL"), 4, cell);
    return R"({"topple": 1, "panel": {"outline": )" + outline + R"(, "thickness": 0.2}, )" + rest;
  };
  CHECK(refusal(with("[[0, 0], [3, 0], [3, 2], [0, 2]]", "0.5", "[]")) == "no error");
  CHECK_THAT(refusal(with("[[0, 0], [3, 0], [3, 2], [1, 3], [0, 2]]", "0.5", "[]")),
             Catch::Contains("the polygon has not four corners"));
  CHECK_THAT(refusal(with("[[0, 0], [3, 0], [0.5, 0.5], [0, 2]]", "0.5", "[]")),
             Catch::Contains("the polygon is not convex"));
  CHECK_THAT(refusal(with("[[0, 0], [900, 0], [900, 900], [0, 900]]", "0.01", "[]")),
             Catch::Contains("fracture") && Catch::Contains("cells"));
  CHECK_THAT(refusal(with("[[0, 0], [90, 0], [90, 90], [0, 90]]", "0.1", "[{\"at\": [9, 9], \"radius\": 20}]")),
             Catch::Contains("hits[0]") && Catch::Contains("50000 chunks"));
}

TEST_CASE("a panel is told from other files by its key, and read from its file") {
  const topple::test::ScratchFolder folder;
  std::ofstream(folder / "p.json") << panel_text;
  std::ofstream(folder / "m.json") << "{\"topple\": 1}";
  std::ofstream(folder / "list.json") << "[1]";
  CHECK(is_panel(folder / "p.json"));
  CHECK_FALSE(is_panel(folder / "m.json"));
  CHECK_FALSE(is_panel(folder / "list.json"));
  CHECK_FALSE(is_panel(folder / "m.3dd"));  // not even opened
  CHECK(read_panel(folder / "p.json").hits.size() == 2);
}
