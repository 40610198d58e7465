#pragma once
// What a panel that breaks keeps between hits: its triangulation, its mesh, and which cells are broken.
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "cell_source.h"
#include "convex_pieces.h"
#include "panel_mesh.h"
#include "topple/fracture/panel.h"
#include "triangulation.h"

namespace topple::fracture {

/// Of the outline and the openings.
struct PanelBounds {
  Vec2 lower, upper;
  [[nodiscard]] double size() const { return (upper - lower).norm(); }
};

class BreakablePanel::Impl {
 public:
  static constexpr int intact_label = 1;  ///< of triangles of what remains

  Impl(const PanelShape& shape, const PanelSettings& settings);
  Impl(const Impl& other)
      : shape(other.shape),
        box(other.box),
        cells(other.cells->clone()),
        triangulation(other.triangulation),
        mesh(other.mesh),
        intact_area(other.intact_area),
        hits(other.hits) {}

  Fracture hit(const Vec2& at, std::optional<double> radius);
  Fracture hold(const std::vector<bool>& held);
  Fracture leave();
  [[nodiscard]] std::vector<int> intact() const;
  [[nodiscard]] double area() const;
  template <class Visit>
  void each_intact(const Visit& visit) const {
    for (int triangle = 0; triangle < triangulation.triangle_slots(); ++triangle)
      if (triangulation.label(triangle) == intact_label) visit(triangle);
  }

  PanelShape shape;
  PanelBounds box;
  std::unique_ptr<CellSource> cells;
  Triangulation triangulation;
  PanelMesh mesh;
  double intact_area = 0;
  std::uint64_t hits = 0;

  /// What hits have changed. Shape (but for the edges that hold it), bounds, and where its cells lie are given.
  template <class Archive>
  void serialize(Archive& archive) {
    auto& [given, bounds, source, cut, faces, whole_area, count, inside, sides] = *this;
    archive(given.held, source->broken_cells(), cut, faces, count);
  }

 private:
  struct Loop {
    std::vector<int> chain;    ///< all vertices along it
    std::vector<int> corners;  ///< what its own corners have become
  };
  [[nodiscard]] bool insert(const Polygon& polygon, Loop& loop);
  bool relabel(const Loop& loop, int from, int to);
  void clip_to_box(Polygon& polygon) const;
  void empty(const std::vector<int>& triangles);
  std::vector<int> gather_cells(int count, ConvexPieces& pieces, Fracture& fracture) const;
  void tidy();
  [[nodiscard]] Vec2 centroid(int triangle) const;

  std::vector<int> inside_, sides_;  ///< of relabel, kept for their memory
};

}  // namespace topple::fracture
