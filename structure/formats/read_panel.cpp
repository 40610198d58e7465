// A panel file: outline, openings, way of breaking, hits.
#include <algorithm>
#include <stdexcept>

#include "formats/json/json_document.h"
#include "formats/read_fracture.h"
#include "topple/fracture/unfit_settings.h"
#include "topple/structure/formats/panel_file.h"

namespace topple::structure {

namespace formats {

namespace {

constexpr std::size_t kMostCorners = 1000, kMostHits = 1000000;

fracture::Polygon read_polygon(const JsonValue& value) {
  value.expect_array(3, kMostCorners);
  fracture::Polygon polygon;
  for (const JsonValue corner : value) {
    polygon.push_back(corner.numbers<fracture::Vec2>());
    for (const JsonValue coordinate : corner) (void)coordinate.in(ranges::place);
  }
  if (!fracture::is_simple(polygon)) value.fail("the polygon crosses or touches itself; accepted: one that does not");
  if (fracture::area(polygon) < 0) std::reverse(polygon.begin() + 1, polygon.end());
  return polygon;
}

void read_shape(const JsonValue& panel, PanelFile& result) {
  panel.expect_object();
  panel.only({"outline", "thickness", "density", "openings"});
  result.shape.outline = read_polygon(panel.require("outline"));
  result.shape.thickness = panel.require("thickness").in({1e-4, 1e3});
  if (const auto density = panel.find("density")) result.density = density->in(ranges::density);
  if (const auto openings = panel.find("openings")) {
    openings->expect_array(0, kMostCorners);
    for (const JsonValue opening : *openings) result.shape.openings.push_back(read_polygon(opening));
  }
}

/// What the cells of a grid can be spread over.
void expect_convex_quadrilateral(const JsonValue& outline, const fracture::Polygon& corners) {
  const auto refuse = [&](const char* found) {
    outline.fail(std::string(found) + "; accepted: a convex quadrilateral, or the method \"local\"");
  };
  if (corners.size() != 4) refuse("the polygon has not four corners");
  for (std::size_t i = 0; i < 4; ++i) {
    const fracture::Vec2 along = corners[(i + 1) % 4] - corners[i], next = corners[(i + 2) % 4] - corners[(i + 1) % 4];
    if (!(along.x() * next.y() - along.y() * next.x() > 0)) refuse("the polygon is not convex");
  }
}

PanelHit read_hit(const JsonValue& value) {
  value.expect_object();
  value.only({"at", "radius"});
  PanelHit hit;
  const JsonValue at = value.require("at");
  hit.at = at.numbers<fracture::Vec2>();
  for (const JsonValue coordinate : at) (void)coordinate.in(ranges::place);
  if (const auto radius = value.find("radius")) hit.radius = radius->in({0, 1e3});
  return hit;
}

/// Refuses the hit by which all together break more chunks than files of them are of use.
void require_few_chunks(const JsonValue& hit, const PanelFile& file, double& chunks) {
  constexpr double most = 50'000;
  const fracture::PanelSettings& settings = file.settings;
  const double radius = file.hits.back().radius.value_or(0);
  if (settings.method == fracture::Method::local) {
    const auto& local = settings.local;
    const double pieces = std::max(radius, local.length[1]) / local.ring + 1;
    chunks += local.points[1] * pieces;
  } else {
    const double across = 2 * radius / settings.cell + 3;
    chunks += across * across;
  }
  if (!(chunks <= most))
    hit.fail("the hits so far may break out more than " + std::to_string(static_cast<int>(most)) +
             " chunks; accepted: fewer or smaller hits, or larger chunks");
}

PanelFile read(const JsonDocument& document) {
  const JsonValue root = document.root();
  root.expect_object();
  root.only({"topple", "panel", "seed", "fracture", "hits"});
  (void)root.require("topple").whole(1, 1);
  PanelFile result;
  result.file = document.name();
  const JsonValue panel = root.require("panel");
  read_shape(panel, result);
  result.settings = read_fracture(root.require("fracture"));
  if (const auto seed = root.find("seed"))
    result.settings.seed = static_cast<std::uint64_t>(seed->whole(0, std::int64_t{1} << 53));
  if (const auto hits = root.find("hits")) {
    hits->expect_array(0, kMostHits);
    double chunks = 0;
    for (const JsonValue hit : *hits) {
      result.hits.push_back(read_hit(hit));
      require_few_chunks(hit, result, chunks);
    }
  }
  if (result.settings.method != fracture::Method::local)
    expect_convex_quadrilateral(panel.require("outline"), result.shape.outline);
  try {  // what only shape and method together can tell
    if (!(fracture::BreakablePanel(result.shape, result.settings).intact_area() > 0))
      panel.require("openings").fail("nothing of the panel is left; accepted: openings beside which some of it is");
  } catch (const fracture::UnfitSettings& error) {
    root.require("fracture").fail(error.what());
  } catch (const std::invalid_argument& error) {
    panel.fail(error.what());
  }
  return result;
}

}  // namespace

}  // namespace formats

PanelFile read_panel(const std::filesystem::path& file) {
  return formats::read(formats::JsonDocument::from_file(file));
}

bool is_panel(const std::filesystem::path& file) {
  if (file.extension() != ".json") return false;
  const auto document = formats::JsonDocument::from_file(file);
  return document.root().is_object() && document.root().find("panel").has_value();
}

PanelFile parse_panel(std::string_view text, const std::string& name) {
  return formats::read(formats::JsonDocument::from_text(text, name));
}

}  // namespace topple::structure
