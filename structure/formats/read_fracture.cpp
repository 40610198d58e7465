#include "formats/read_fracture.h"

namespace topple::structure::formats {

namespace {

constexpr std::int64_t kMostPoints =
    1000;  ///< corners of one hit's damage; the pattern stops looking like one long before

/// A length that chunks can have, in m: what is smaller than a centimetre is dust, and there would be millions of it.
double read_length(const JsonValue& value, double unit) {
  constexpr NumberRange metres{1e-2, 1e3};
  const double length = value.positive() * unit;
  if (!metres.contains(length)) value.refuse(metres.text() + ", in m");
  return length;
}

fracture::PanelSettings read_cells(const JsonValue& value, fracture::Method method, double unit) {
  value.only({"method", "cell", "jitter"});
  fracture::PanelSettings settings;
  settings.method = method;
  if (const auto cell = value.find("cell")) settings.cell = read_length(*cell, unit);
  if (const auto jitter = value.find("jitter")) {
    settings.jitter = jitter->in(ranges::unit);
  }
  return settings;
}

fracture::PanelSettings read_local(const JsonValue& value, double unit) {
  value.only({"method", "points", "length", "ring"});
  fracture::PanelSettings settings;
  settings.method = fracture::Method::local;
  if (const auto points = value.find("points")) {
    points->expect_array(2, 2);
    std::size_t i = 0;
    for (const JsonValue count : *points) settings.local.points[i++] = static_cast<int>(count.whole(3, kMostPoints));
    if (settings.local.points[1] < settings.local.points[0]) points->refuse("the least number, then the greatest");
  }
  if (const auto length = value.find("length")) {
    length->expect_array(2, 2);
    std::size_t i = 0;
    for (const JsonValue bound : *length) settings.local.length[i++] = read_length(bound, unit);
    if (settings.local.length[1] < settings.local.length[0]) length->refuse("the least length, then the greatest");
  }
  if (const auto ring = value.find("ring")) settings.local.ring = read_length(*ring, unit);
  return settings;
}

}  // namespace

const char* method_name(fracture::Method method) {
  switch (method) {
    case fracture::Method::voronoi:
      return "voronoi";
    case fracture::Method::quadrilateral:
      return "quadrilateral";
    case fracture::Method::local:
      return "local";
  }
  return "";
}

fracture::PanelSettings read_fracture(const JsonValue& value, double length) {
  value.expect_object();
  constexpr std::string_view accepted = "\"voronoi\", \"quadrilateral\" or \"local\"";
  const JsonValue method = value.require("method");
  const std::string_view name = method.text(accepted);
  if (name == "voronoi") return read_cells(value, fracture::Method::voronoi, length);
  if (name == "quadrilateral") return read_cells(value, fracture::Method::quadrilateral, length);
  if (name == "local") return read_local(value, length);
  method.refuse(accepted);
}

}  // namespace topple::structure::formats
