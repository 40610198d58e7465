#include "visual/chunk_prism.h"

#include <algorithm>

#include "topple/fracture/polygon.h"

namespace topple::structure {

namespace {

Vec3 local(const Building& building, PanelId panel, const Vec3& point) {
  return building[panel].axes * (point - building[building[panel].nodes[0]].position);
}

double turn(const Vec2& a, const Vec2& b, const Vec2& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

/// A. Andrew's monotone chain (Information Processing Letters 9, 1979); points on a side are left out.
std::vector<Vec2> convex_hull(std::vector<Vec2> points) {
  constexpr double straight = 1e-12;  // m2
  const auto before = [](const Vec2& a, const Vec2& b) { return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y(); };
  std::sort(points.begin(), points.end(), before);
  std::vector<Vec2> hull;
  for (const bool upper : {false, true}) {
    const std::size_t begin = hull.size();
    for (const Vec2& point : points) {
      while (hull.size() >= begin + 2 && turn(hull[hull.size() - 2], hull.back(), point) <= straight) hull.pop_back();
      hull.push_back(point);
    }
    hull.pop_back();
    if (!upper) std::reverse(points.begin(), points.end());
  }
  return hull;
}

}  // namespace

double height_over(const Building& building, PanelId panel, const Vec3& point) {
  return local(building, panel, point).z();
}

bool ChunkPrism::holds(const Building& building, const Vec3& point) const {
  return fracture::contains(outline, local(building, panel, point).head<2>());
}

Vec3 ChunkPrism::centre(const Building& building) const {
  const Vec2 middle = fracture::centroid(outline);
  const Panel& own = building[panel];
  return building[own.nodes[0]].position + own.axes.transpose() * Vec3(middle.x(), middle.y(), 0);
}

std::optional<ChunkPrism> chunk_prism(const Building& building, const NameIndex& names, const BodyView& body) {
  if (!body.chunk) return std::nullopt;
  // A chunk is called by its panel's name and its number.
  const std::string name(body.name);
  const auto panel = names.panel(name.substr(0, name.rfind('#')));
  if (!panel) return std::nullopt;
  ChunkPrism prism;
  prism.body = body.id.value;
  prism.panel = *panel;
  std::vector<Vec2> corners;
  for (const Vec3& position : body.chunk->positions)
    corners.push_back(local(building, *panel, body.rest_centre + position).head<2>());
  prism.outline = convex_hull(std::move(corners));
  if (prism.outline.size() < 3) return std::nullopt;
  return prism;
}

CutOut cut_out(const fracture::Mesh& mesh, const Building& building, const ChunkPrism& chunk, double low, double high) {
  const Panel& panel = building[chunk.panel];
  const Vec3 origin = building[panel.nodes[0]].position;
  const auto lift = [&](const Vec3& at) -> Vec3 { return panel.axes.transpose() * at; };
  std::vector<fracture::Plane> planes{{origin + lift(Vec3(0, 0, high)), lift(Vec3::UnitZ())},
                                      {origin + lift(Vec3(0, 0, low)), lift(-Vec3::UnitZ())}};
  for (std::size_t i = 0; i < chunk.outline.size(); ++i) {
    const Vec2& corner = chunk.outline[i];
    const Vec2 along = chunk.outline[(i + 1) % chunk.outline.size()] - corner;
    planes.push_back({origin + lift(Vec3(corner.x(), corner.y(), 0)), lift(Vec3(along.y(), -along.x(), 0))});
  }
  CutOut result;
  result.inside = mesh;
  for (const fracture::Plane& plane : planes) {
    fracture::CutSolid halves = fracture::cut(result.inside, plane);
    if (!halves.above.triangles.empty()) result.outside.push_back(std::move(halves.above));
    result.inside = std::move(halves.below);
    if (result.inside.triangles.empty()) break;
  }
  return result;
}

}  // namespace topple::structure
