#include "topple/fracture/panel.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <stdexcept>
#include <utility>

#include "grid.h"
#include "loose_parts.h"
#include "panel_impl.h"
#include "predicates.h"
#include "topple/fracture/unfit_settings.h"

namespace topple::fracture {

namespace {

constexpr double kOutlineTolerance = 1e-7;  ///< of the panel's size
constexpr double kMargin = 0.25;            ///< of the panel's size: empty space around it in the triangulation
constexpr double kLeastRing = 1e-4;         ///< of the panel's size
constexpr int kEmpty = 0, kFirstPiece = 2;

PanelBounds bounds(const PanelShape& shape) {
  PanelBounds box{Vec2::Constant(INFINITY), Vec2::Constant(-INFINITY)};
  const auto take = [&](const Polygon& polygon) {
    for (const Vec2& point : polygon) {
      if (!point.allFinite()) throw std::invalid_argument("a coordinate is not finite");
      box.lower = box.lower.cwiseMin(point);
      box.upper = box.upper.cwiseMax(point);
    }
  };
  take(shape.outline);
  for (const Polygon& opening : shape.openings) take(opening);
  return box;
}

void check(const PanelShape& shape) {
  if (!(shape.thickness > 0 && std::isfinite(shape.thickness)))
    throw std::invalid_argument("thickness must be above 0");
  if (!is_simple(shape.outline))
    throw std::invalid_argument("the outline must be a polygon that does not cross itself");
  if (!(area(shape.outline) > 0)) throw std::invalid_argument("the outline must go counter-clockwise");
  for (const Polygon& opening : shape.openings)
    if (!is_simple(opening)) throw std::invalid_argument("an opening must be a polygon that does not cross itself");
  if (!shape.held.empty() && shape.held.size() != shape.outline.size())
    throw std::invalid_argument("held must have an entry for each edge of the outline");
}

}  // namespace

void expect_fit(const PanelShape& shape, const PanelSettings& settings) {
  if (settings.method == Method::local) {
    if (settings.local.ring < bounds(shape).size() * kLeastRing)
      throw UnfitSettings("ring is too small for the panel; accepted: at least a ten-thousandth of its size");
  } else if (shape.outline.size() == 4) {
    const Polygon& corner = shape.outline;
    (void)cells_in_grid({corner[0], corner[1], corner[2], corner[3]}, settings.cell, {});
  }
}

BreakablePanel::Impl::Impl(const PanelShape& given, const PanelSettings& settings)
    : shape((check(given), given)),
      box(bounds(given)),
      cells(make_cell_source(given, settings)),
      triangulation(box.lower - Vec2::Constant(kMargin * box.size()), box.upper + Vec2::Constant(kMargin * box.size()),
                    kOutlineTolerance * box.size()),
      mesh(given.thickness) {
  expect_fit(given, settings);
  if (shape.held.empty()) shape.held.assign(shape.outline.size(), true);
  Loop border;
  if (!insert(shape.outline, border) || border.corners.size() != shape.outline.size())
    throw std::invalid_argument("corners of the outline lie too close together");
  (void)relabel(border, kEmpty, intact_label);
  std::size_t edge = shape.outline.size() - 1;  // the chain begins at the first corner's end of the last edge
  for (std::size_t i = 0; i < border.chain.size(); ++i) {
    const int from = border.chain[i], to = border.chain[(i + 1) % border.chain.size()];
    const auto corner = std::find(border.corners.begin(), border.corners.end(), from);
    if (corner != border.corners.end()) edge = static_cast<std::size_t>(corner - border.corners.begin());
    triangulation.fix(triangulation.find_edge(from, to), static_cast<int>(edge));
  }
  Loop loop;
  for (const Polygon& opening : shape.openings)
    if (insert(opening, loop)) (void)relabel(loop, intact_label, kEmpty);
  tidy();
  intact_area = area();
}

/// Makes a closed loop of fixed edges; false when nothing of it is left at the triangulation's tolerance.
bool BreakablePanel::Impl::insert(const Polygon& polygon, Loop& loop) {
  loop.chain.clear();
  loop.corners.clear();
  for (const Vec2& point : polygon) {
    const int vertex = triangulation.add_point(point);
    if (std::find(loop.corners.begin(), loop.corners.end(), vertex) == loop.corners.end())
      loop.corners.push_back(vertex);
  }
  if (loop.corners.size() < 3) return false;
  for (std::size_t i = 0; i < loop.corners.size(); ++i)
    triangulation.add_segment(loop.corners[i], loop.corners[(i + 1) % loop.corners.size()], loop.chain);
  return true;
}

Vec2 BreakablePanel::Impl::centroid(int triangle) const {
  const Vec2& first = triangulation.point(triangulation.origin(Triangulation::half(triangle, 0)));
  return first + ((triangulation.point(triangulation.origin(Triangulation::half(triangle, 1))) - first) +
                  (triangulation.point(triangulation.origin(Triangulation::half(triangle, 2))) - first)) /
                     3;
}

/// Gives the triangles inside a loop a new label where they have the old one, and settles all edges around; whether any
/// had it.
bool BreakablePanel::Impl::relabel(const Loop& loop, int from, int to) {
  std::vector<int>&inside = inside_, &sides = sides_;
  const bool simple = triangulation.enclose(loop.chain, inside, sides);
  if (!simple) {
    Polygon polygon;
    for (const int vertex : loop.chain) polygon.push_back(triangulation.point(vertex));
    inside = triangulation.collect(loop.chain, [&](int triangle) { return encloses(polygon, centroid(triangle)); });
  }
  bool changed = false;
  for (const int triangle : inside) {
    if (triangulation.label(triangle) != from) continue;
    triangulation.set_label(triangle, to);
    changed = true;
  }
  for (const int triangle : inside) triangulation.settle_sides(triangle);
  // Where the loop runs through empty space it separates nothing.
  for (const int edge : sides) triangulation.settle_side(edge);
  if (!simple)
    for (const int vertex : loop.chain)
      for (const int triangle : triangulation.star(vertex)) triangulation.settle_sides(triangle);
  return changed;
}

/// Cells reach over the border; what is farther out than half the margin is cut off.
void BreakablePanel::Impl::clip_to_box(Polygon& polygon) const {
  const Vec2 margin = Vec2::Constant(kMargin / 2 * box.size());
  const Vec2 lower = box.lower - margin, upper = box.upper + margin;
  bool outside = false;
  for (const Vec2& point : polygon)
    outside = outside || (point - lower).minCoeff() < 0 || (upper - point).minCoeff() < 0;
  if (!outside) return;
  LabelledPolygon clipped{polygon, std::vector<int>(polygon.size(), 0)};
  clip(clipped, lower, -Vec2::UnitX(), 0);
  clip(clipped, lower, -Vec2::UnitY(), 0);
  clip(clipped, upper, Vec2::UnitX(), 0);
  clip(clipped, upper, Vec2::UnitY(), 0);
  polygon = std::move(clipped.vertices);
}

/// Drops vertices that no border needs any more, so that the triangulation stays as small as the damage is.
void BreakablePanel::Impl::tidy() {
  std::vector<int> vertices;
  std::vector<char> listed(static_cast<std::size_t>(triangulation.vertex_slots()), 0);
  for (const int triangle : triangulation.touched())
    if (triangulation.alive(triangle))
      for (const int edge : Triangulation::sides(triangle)) {
        const int vertex = triangulation.origin(edge);
        if (!std::exchange(listed[static_cast<std::size_t>(vertex)], 1)) vertices.push_back(vertex);
      }
  std::sort(vertices.begin(), vertices.end());
  for (const int vertex : vertices) (void)triangulation.remove_vertex(vertex);
  mesh.update(triangulation, triangulation.touched(), intact_label);
  triangulation.clear_touched();
}

Fracture BreakablePanel::Impl::hit(const Vec2& at, std::optional<double> radius) {
  Fracture fracture;
  const double nearest = (at - at.cwiseMax(box.lower).cwiseMin(box.upper)).norm();
  std::vector<Polygon> broken = cells->broken(at, radius, nearest, nearest + box.size(), ++hits);
  int label = kFirstPiece;
  Loop loop;
  for (Polygon& cell : broken) {
    clip_to_box(cell);
    if (cell.size() < 3) continue;
    if (insert(cell, loop) && relabel(loop, intact_label, label)) ++label;
  }
  fracture.cells = broken.size();
  ConvexPieces pieces(triangulation);
  std::vector<int> removed = gather_cells(label - kFirstPiece, pieces, fracture);
  if (!removed.empty())
    for (const std::vector<int>& island : LooseParts(triangulation, shape.held, intact_label).beside(removed)) {
      pieces.append(island, false, fracture.chunks);
      removed.insert(removed.end(), island.begin(), island.end());
    }
  empty(removed);
  fracture.triangles_changed = triangulation.touched().size();
  tidy();
  return fracture;
}

/// All triangles of the cells, the chunks of which are appended cell by cell: when all is cut, since later cells change
/// the triangles of earlier ones.
std::vector<int> BreakablePanel::Impl::gather_cells(int count, ConvexPieces& pieces, Fracture& fracture) const {
  std::vector<int> all;
  std::vector<std::size_t> begin(static_cast<std::size_t>(count) + 2, 0);  // of cell i at i + 1, while they are counted
  for (const int triangle : triangulation.touched()) {
    if (!triangulation.alive(triangle) || triangulation.label(triangle) < kFirstPiece) continue;
    all.push_back(triangle);
    ++begin[static_cast<std::size_t>(triangulation.label(triangle) - kFirstPiece) + 2];
  }
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  std::vector<int> sorted(all.size());
  for (const int triangle : all)
    sorted[begin[static_cast<std::size_t>(triangulation.label(triangle) - kFirstPiece) + 1]++] = triangle;
  fracture.chunks.reserve(static_cast<std::size_t>(count));
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i)
    pieces.append(std::span(sorted).subspan(begin[i], begin[i + 1] - begin[i]), true, fracture.chunks);
  return all;
}

void BreakablePanel::Impl::empty(const std::vector<int>& triangles) {
  for (const int triangle : triangles) triangulation.set_label(triangle, kEmpty);
  for (const int triangle : triangles) triangulation.settle_sides(triangle);
}

std::vector<int> BreakablePanel::Impl::intact() const {
  std::vector<int> all;
  each_intact([&](int triangle) { all.push_back(triangle); });
  return all;
}

Fracture BreakablePanel::Impl::hold(const std::vector<bool>& held) {
  shape.held = held;
  Fracture fracture;
  ConvexPieces pieces(triangulation);
  for (const std::vector<int>& island : LooseParts(triangulation, shape.held, intact_label).around(intact())) {
    pieces.append(island, false, fracture.chunks);
    empty(island);
  }
  fracture.triangles_changed = triangulation.touched().size();
  tidy();
  return fracture;
}

Fracture BreakablePanel::Impl::leave() {
  Fracture fracture;
  const std::vector<int> all = intact();
  ConvexPieces(triangulation).append(all, false, fracture.chunks);
  empty(all);
  fracture.triangles_changed = triangulation.touched().size();
  tidy();
  return fracture;
}

double BreakablePanel::Impl::area() const {
  double doubled = 0;
  each_intact([&](int triangle) { doubled += triangulation.doubled_area(triangle); });
  return doubled / 2;
}

BreakablePanel::BreakablePanel(const PanelShape& shape, const PanelSettings& settings)
    : impl_(std::make_unique<Impl>(shape, settings)) {}
BreakablePanel::~BreakablePanel() = default;
BreakablePanel::BreakablePanel(const BreakablePanel& other) : impl_(std::make_unique<Impl>(*other.impl_)) {}
BreakablePanel::BreakablePanel(BreakablePanel&&) noexcept = default;
BreakablePanel& BreakablePanel::operator=(BreakablePanel&&) noexcept = default;

Fracture BreakablePanel::hit(const Vec2& at, std::optional<double> radius) {
  if (!at.allFinite()) throw std::invalid_argument("the point of a hit must be finite");
  if (radius && !(*radius >= 0 && std::isfinite(*radius)))
    throw std::invalid_argument("the radius of a hit must be finite and not below 0");
  return impl_->hit(at, radius);
}

Fracture BreakablePanel::hold(const std::vector<bool>& held) {
  if (held.size() != impl_->shape.outline.size())
    throw std::invalid_argument("held must have an entry for each edge of the outline");
  return impl_->hold(held);
}

Fracture BreakablePanel::leave() { return impl_->leave(); }

const Mesh& BreakablePanel::mesh() const { return impl_->mesh.mesh(); }
const PanelShape& BreakablePanel::shape() const { return impl_->shape; }
double BreakablePanel::area() const { return impl_->area(); }
double BreakablePanel::intact_area() const { return impl_->intact_area; }
std::uint64_t BreakablePanel::hits() const { return impl_->hits; }
double BreakablePanel::tolerance() const { return impl_->triangulation.tolerance(); }
bool BreakablePanel::valid() const { return impl_->triangulation.valid() && impl_->triangulation.unfinished() == 0; }

bool BreakablePanel::holds(const Vec2& point) const {
  if (!encloses(impl_->shape.outline, point)) return false;
  return impl_->triangulation.label(impl_->triangulation.locate(point)) == Impl::intact_label;
}

double BreakablePanel::intact_length(std::size_t edge) const {
  double length = 0;
  impl_->each_intact([&](int triangle) {
    const Triangulation& cut = impl_->triangulation;
    for (const int side : Triangulation::sides(triangle))
      if (cut.tag(side) == static_cast<int>(edge))
        length += (cut.point(cut.target(side)) - cut.point(cut.origin(side))).norm();
  });
  return length;
}

std::vector<std::array<Vec2, 3>> BreakablePanel::triangles() const {
  std::vector<std::array<Vec2, 3>> result;
  impl_->each_intact([&](int triangle) {
    const Triangulation& cut = impl_->triangulation;
    const int edge = Triangulation::half(triangle, 0);
    result.push_back({cut.point(cut.origin(edge)), cut.point(cut.origin(edge + 1)), cut.point(cut.origin(edge + 2))});
  });
  return result;
}

std::vector<Chunk> BreakablePanel::pieces() const {
  std::vector<Chunk> pieces;
  ConvexPieces(impl_->triangulation).append(impl_->intact(), false, pieces);
  return pieces;
}

Mesh mesh_of(const Chunk& chunk, double thickness) { return prism_mesh(chunk.outline, chunk.face, thickness); }

MassProperties properties_of(const Chunk& chunk, double thickness, double density) {
  return prism_properties(chunk.outline, thickness, density);
}

}  // namespace topple::fracture
