#include "simulation/panel_chunks.h"

#include <algorithm>

#include "topple/fracture/panel.h"

namespace topple::structure {

namespace {

/// Distance by which chunks' collision shapes stay within their outlines, m, and the largest share of their size.
constexpr double inset = 0.006, largest_inset = 0.2;
/// Of a chunk's area: with less of it inside the panel's own shape, its collision shape is a small one in its middle.
constexpr double least_inside = 0.05, small_share = 0.4;

/// The plane of a panel in the building.
struct PanelPlane {
  Vec3 origin;
  Mat3 axes;
  [[nodiscard]] fracture::Vec2 flat(const Vec3& point) const { return (axes * (point - origin)).head<2>(); }
  [[nodiscard]] Vec3 lift(const Vec3& local) const { return origin + axes.transpose() * local; }
};

fracture::PanelShape shape_of(const Building& building, const Panel& panel, const PanelPlane& plane) {
  fracture::PanelShape shape;
  for (const NodeId node : panel.nodes) shape.outline.push_back(plane.flat(building[node].position));
  shape.thickness = panel.thickness;
  shape.openings = panel.openings;
  return shape;
}

/// The part of a chunk's outline that lies within the space of the panel's own shape.
fracture::Polygon inside(const fracture::Polygon& outline, const fracture::Polygon& space) {
  fracture::LabelledPolygon kept{outline, std::vector<int>(outline.size(), 0)};
  for (std::size_t i = 0; i < space.size() && !kept.vertices.empty(); ++i) {
    const fracture::Vec2 along = space[(i + 1) % space.size()] - space[i];
    fracture::clip(kept, space[i], fracture::Vec2(along.y(), -along.x()), 0);
  }
  return kept.vertices;
}

std::vector<Vec3> hull_of(const fracture::Polygon& outline, const fracture::Polygon& space, double thickness,
                          const PanelPlane& plane, const Vec3& centre) {
  fracture::Polygon kept = inside(outline, space);
  const double whole = fracture::area(outline);
  double most = largest_inset;
  if (kept.size() < 3 || fracture::area(kept) < least_inside * whole) {
    kept = outline;
    most = 1 - small_share;
  }
  const fracture::Vec2 middle = fracture::centroid(kept);
  std::vector<Vec3> hull;
  for (const fracture::Vec2& corner : kept) {
    const fracture::Vec2 out = corner - middle;
    const double share = most > largest_inset ? most : std::min(most, inset / std::max(out.norm(), 1e-9));
    const fracture::Vec2 place = middle + (1 - share) * out;
    for (const double side : {-0.5, 0.5})
      hull.push_back(plane.lift(Vec3(place.x(), place.y(), side * thickness)) - centre);
  }
  return hull;
}

PanelChunk lift(const fracture::Chunk& chunk, const Panel& panel, double density, const fracture::Polygon& space,
                const PanelPlane& plane) {
  const fracture::MassProperties flat = properties_of(chunk, panel.thickness, density);
  PanelChunk result;
  result.hit = chunk.hit;
  result.volume = flat.volume;
  result.rest.mass = flat.mass;
  result.rest.centre = plane.lift(flat.centre);
  result.rest.inertia = plane.axes.transpose() * flat.inertia * plane.axes;
  result.hull = hull_of(chunk.outline, space, panel.thickness, plane, result.rest.centre);
  fracture::Mesh mesh = mesh_of(chunk, panel.thickness);
  for (Vec3& position : mesh.positions) position = plane.axes.transpose() * (position - flat.centre);
  for (Vec3& normal : mesh.normals) normal = plane.axes.transpose() * normal;
  result.mesh = std::make_shared<const fracture::Mesh>(std::move(mesh));
  return result;
}

}  // namespace

std::vector<PanelChunk> break_panel(const Building& building, PanelId id, double mass, const std::vector<Vec3>& space,
                                    const Vec3& at, std::optional<double> radius,
                                    const fracture::PanelSettings& settings) {
  const Panel& panel = building[id];
  const PanelPlane plane{building[panel.nodes[0]].position, panel.axes};
  fracture::BreakablePanel breaking(shape_of(building, panel, plane), settings);
  const double density = mass / (breaking.intact_area() * panel.thickness);
  const fracture::Fracture hit = breaking.hit(plane.flat(at), radius);
  if (hit.chunks.empty()) return {};
  fracture::Polygon flat_space;
  for (std::size_t i = 0; i < space.size(); i += 2) flat_space.push_back(plane.flat(space[i]));
  std::vector<PanelChunk> chunks;
  for (const fracture::Chunk& chunk : hit.chunks) chunks.push_back(lift(chunk, panel, density, flat_space, plane));
  for (const fracture::Chunk& chunk : breaking.leave().chunks)
    chunks.push_back(lift(chunk, panel, density, flat_space, plane));
  return chunks;
}

}  // namespace topple::structure
