#include "simulation/fracture/broken_panel.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "topple/fracture/unfit_settings.h"
#include "topple/structure/error.h"

namespace topple::structure {

namespace {

/// Distance by which collision shapes stay within their outlines, m, and the largest share of their size.
constexpr double inset = 0.006, largest_inset = 0.2;
/// Of a piece's size: its collision shape where what lies inside of the panel's own shape would not do.
constexpr double small_share = 0.4;

/// The part of an outline that lies within the space of the panel's own shape.
fracture::Polygon inside(const fracture::Polygon& outline, const fracture::Polygon& space) {
  fracture::LabelledPolygon kept{outline, std::vector<int>(outline.size(), 0)};
  for (std::size_t i = 0; i < space.size() && !kept.vertices.empty(); ++i) {
    const Vec2 along = space[(i + 1) % space.size()] - space[i];
    fracture::clip(kept, space[i], Vec2(along.y(), -along.x()), 0);
  }
  return kept.vertices;
}

/// A corner nearer than this to the line between its neighbours, m, makes a collision shape no truer. What a pair of
/// shapes costs goes with the product of their edges, so they have at most so many corners.
constexpr double flat_corner = 0.005;
constexpr std::size_t most_corners = 8;

/// Leaves corners out of a convex outline, those first that take the least area with them.
void leave_out_corners(fracture::Polygon& outline) {
  while (outline.size() > 3) {
    std::size_t least = 0;
    double least_area = INFINITY, height = 0;
    for (std::size_t i = 0; i < outline.size(); ++i) {
      const Vec2 &before = outline[(i + outline.size() - 1) % outline.size()],
                 &after = outline[(i + 1) % outline.size()];
      const Vec2 chord = after - before, arm = outline[i] - before;
      const double doubled = std::abs(chord.x() * arm.y() - chord.y() * arm.x());
      if (doubled >= least_area) continue;
      least = i;
      least_area = doubled;
      height = doubled / std::max(chord.norm(), 1e-9);
    }
    if (outline.size() <= most_corners && height > flat_corner) return;
    outline.erase(outline.begin() + static_cast<std::ptrdiff_t>(least));
  }
}

/// Each corner drawn towards the middle, by a share that its distance from there tells.
template <class Share>
fracture::Polygon drawn_in(fracture::Polygon outline, const Share& share) {
  leave_out_corners(outline);
  const Vec2 middle = fracture::centroid(outline);
  for (Vec2& corner : outline) corner = middle + (1 - share((corner - middle).norm())) * (corner - middle);
  return outline;
}

/// The outline of a piece's collision shape. It is about the centre of mass: a piece that hung from a shape beside it
/// would swing through the ground.
fracture::Polygon shape_within(const fracture::Polygon& outline, const fracture::Polygon& space) {
  if (fracture::Polygon kept = inside(outline, space); kept.size() > 2) {
    kept = drawn_in(std::move(kept), [](double out) { return std::min(largest_inset, inset / std::max(out, 1e-9)); });
    if (fracture::contains(kept, fracture::centroid(outline))) return kept;
  }
  return drawn_in(outline, [](double) { return 1 - small_share; });
}

/// Something of the panel is nearer to a point than this.
bool reaches_into(const fracture::BreakablePanel& panel, const Vec2& centre, double radius) {
  const auto near_side = [&](const Vec2& a, const Vec2& b) {
    const Vec2 way = b - a;
    const double along = std::clamp((centre - a).dot(way) / way.squaredNorm(), 0.0, 1.0);
    return (a + along * way - centre).norm() < radius;
  };
  for (const auto& [a, b, c] : panel.triangles())
    if (near_side(a, b) || near_side(b, c) || near_side(c, a) || fracture::contains({a, b, c}, centre)) return true;
  return false;
}

}  // namespace

fracture::PanelShape BrokenPanel::shape_of(const Building& building, const Panel& panel, const Plane& plane,
                                           const std::array<bool, 4>& held) {
  fracture::PanelShape shape;
  for (const NodeId node : panel.nodes) shape.outline.push_back(plane.flat(building[node].position));
  shape.thickness = panel.thickness;
  shape.openings = panel.openings;
  shape.held.assign(held.begin(), held.end());
  return shape;
}

void BrokenPanel::expect_fit(const Building& building, const Panel& panel, const fracture::PanelSettings& settings) {
  try {
    fracture::expect_fit(shape_of(building, panel, {building[panel.nodes[0]].position, panel.axes}, {}), settings);
  } catch (const fracture::UnfitSettings& error) {
    throw InputError(building.file + ", panels." + panel.name + ": fracture: " + error.what());
  }
}

BrokenPanel::BrokenPanel(const Building& building, PanelId id, double mass, const std::vector<Vec3>& space,
                         const fracture::PanelSettings& settings, const std::array<bool, 4>& held)
    : plane_{building[building[id].nodes[0]].position, building[id].axes},
      thickness_(building[id].thickness),
      panel_(shape_of(building, building[id], plane_, held), settings),
      density_(mass / (panel_.intact_area() * thickness_)),
      held_(held) {
  for (std::size_t i = 0; i < space.size(); i += 2) space_.push_back(plane_.flat(space[i]));
}

std::vector<PanelChunk> BrokenPanel::hit(const Vec3& at, std::optional<double> radius) {
  return chunks_of(panel_.hit(plane_.flat(at), radius));
}

std::vector<PanelChunk> BrokenPanel::hit_through(const Vec3& at, std::optional<double> first, double radius) {
  // Grazing a cell by less than this share of its radius a body pushes past.
  constexpr double grazed = 0.05, growth = 1.25;
  const double most = radius + (space_[2] - space_[0]).norm();
  std::optional<double> wanted = first;
  // Tried out on copies: the one hit that is carried out then leaves no slivers of others.
  for (double reach = std::max(radius, first.value_or(radius)); reach < most; reach *= growth) {
    if (reach > std::max(radius, first.value_or(radius))) wanted = reach;
    fracture::BreakablePanel trial(panel_);
    if (trial.hit(plane_.flat(at), wanted).chunks.empty()) return {};
    if (!reaches_into(trial, plane_.flat(at), (1 - grazed) * radius)) break;
  }
  return hit(at, wanted);
}

std::vector<PanelChunk> BrokenPanel::hold(const std::array<bool, 4>& held) {
  held_ = held;
  return chunks_of(panel_.hold(std::vector<bool>(held.begin(), held.end())));
}

std::vector<PanelChunk> BrokenPanel::leave() { return chunks_of(panel_.leave()); }

bool BrokenPanel::holds(const Vec3& at) const { return panel_.holds(plane_.flat(at)); }

std::vector<PanelChunk> BrokenPanel::chunks_of(const fracture::Fracture& fracture) {
  std::vector<PanelChunk> chunks;
  if (fracture.chunks.empty()) return chunks;
  for (const fracture::Chunk& chunk : fracture.chunks) {
    chunks.push_back(lift(chunk));
    holes_.push_back(chunk.outline);
  }
  chunks_out_ += static_cast<int>(chunks.size());
  description_.reset();
  mesh_.reset();
  return chunks;
}

PanelChunk BrokenPanel::lift(const fracture::Chunk& chunk) const {
  const fracture::MassProperties flat = properties_of(chunk, thickness_, density_);
  PanelChunk result;
  result.hit = chunk.hit;
  result.volume = flat.volume;
  result.rest.mass = flat.mass;
  result.rest.centre = plane_.lift(flat.centre);
  result.rest.inertia = plane_.axes.transpose() * flat.inertia * plane_.axes;
  for (const Vec2& corner : shape_within(chunk.outline, space_))
    for (const double side : {-0.5, 0.5})
      result.hull.push_back(plane_.lift(Vec3(corner.x(), corner.y(), side * thickness_)) - result.rest.centre);
  fracture::Mesh mesh = mesh_of(chunk, thickness_);
  for (Vec3& position : mesh.positions) position = plane_.axes.transpose() * (position - flat.centre);
  for (Vec3& normal : mesh.normals) normal = plane_.axes.transpose() * normal;
  result.mesh = std::make_shared<const fracture::Mesh>(std::move(mesh));
  return result;
}

const BrokenPanel::Description& BrokenPanel::described() const {
  if (description_) return *description_;
  Description& now = description_.emplace();
  for (const fracture::Chunk& piece : panel_.pieces()) {
    const fracture::MassProperties flat = properties_of(piece, thickness_, density_);
    now.volume += flat.volume;
    now.rest.add({flat.mass, plane_.lift(flat.centre), plane_.axes.transpose() * flat.inertia * plane_.axes});
    std::vector<Vec3>& hull = now.hulls.emplace_back();
    for (const Vec2& corner : shape_within(piece.outline, space_))
      for (const double side : {-0.5, 0.5})
        hull.push_back(plane_.lift(Vec3(corner.x(), corner.y(), side * thickness_)));
  }
  return now;
}

const std::shared_ptr<const fracture::Mesh>& BrokenPanel::mesh() const {
  if (mesh_) return mesh_;
  fracture::Mesh mesh = compact(panel_.mesh());
  for (Vec3& position : mesh.positions) position = plane_.lift(position);
  for (Vec3& normal : mesh.normals) normal = plane_.axes.transpose() * normal;
  mesh_ = std::make_shared<const fracture::Mesh>(std::move(mesh));
  return mesh_;
}

PanelRemains BrokenPanel::remains() const {
  PanelRemains remains;
  remains.share = volume() / (panel_.intact_area() * thickness_);
  remains.holes = holes_;
  for (std::size_t edge = 0; edge < 4; ++edge) remains.edge_length[edge] = panel_.intact_length(edge);
  return remains;
}

/// T. Moeller and B. Trumbore, "Fast, minimum storage ray-triangle intersection" (1997), over all triangles.
std::optional<double> BrokenPanel::ray(const Vec3& from, const Vec3& direction) const {
  std::optional<double> nearest;
  const fracture::Mesh& surface = *mesh();
  for (const auto& [i, j, k] : surface.triangles) {
    const auto at = [&](int v) -> const Vec3& { return surface.positions[static_cast<std::size_t>(v)]; };
    const Vec3 a = at(j) - at(i), b = at(k) - at(i), across = direction.cross(b);
    const double determinant = a.dot(across);
    if (determinant == 0) continue;
    const Vec3 offset = from - at(i);
    const double u = offset.dot(across) / determinant;
    const Vec3 turned = offset.cross(a);
    const double v = direction.dot(turned) / determinant, distance = b.dot(turned) / determinant;
    if (u < 0 || v < 0 || u + v > 1 || distance < 0) continue;
    if (!nearest || distance < *nearest) nearest = distance;
  }
  return nearest;
}

}  // namespace topple::structure
