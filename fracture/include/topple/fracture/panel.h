#pragma once
// A panel that breaks where it is hit: what remains of it, the chunks that leave, and the meshes of both.
//
// Three methods say which cells a hit breaks (voronoi.h, quadrilaterals.h, local_damage.h). One triangulation cuts them
// out of what is still there, so that whatever lies over the border, an opening or earlier damage is clipped and united
// exactly, neighbouring pieces share their vertices bit for bit, and the areas of all pieces add up to the panel.
#include <array>
#include <cstdint>
#include <iosfwd>
#include <memory>
#include <optional>
#include <vector>

#include "topple/fracture/mesh.h"
#include "topple/fracture/panel_settings.h"
#include "topple/fracture/polygon.h"
#include "topple/fracture/prism.h"

namespace topple::fracture {

/// A panel before anything hit it: a flat plate in its own axes.
struct PanelShape {
  /// Counter-clockwise, m. A convex quadrilateral; with Method::local any simple polygon.
  Polygon outline;
  double thickness = 0;  ///< m
  std::vector<Polygon>
      openings;  ///< simple polygons, either way round; what lies outside the outline counts for nothing
  /// For each edge of the outline whether it holds the panel (edge i runs from corner i to i + 1); empty: all do.
  std::vector<bool> held;
};

/// A convex piece that has left its panel: a straight prism. Convex up to the panel's tolerance.
struct Chunk {
  Polygon outline;                       ///< panel axes, m, counter-clockwise
  std::vector<std::array<int, 3>> face;  ///< triangles of the outline's corners
  bool hit = true;                       ///< false: nothing held it any more
};

/// What one hit did.
struct Fracture {
  std::vector<Chunk> chunks;          ///< convex pieces that left
  std::size_t cells = 0;              ///< that the method broke
  std::size_t triangles_changed = 0;  ///< of the triangulation: the measure of the work done
};

/// Throws UnfitSettings where cells or ring cracks are too small for the panel, as BreakablePanel() does, and makes
/// nothing.
void expect_fit(const PanelShape& shape, const PanelSettings& settings);

/// One panel that is hit again and again: it keeps what remains as a triangulation.
class BreakablePanel {
 public:
  /// Throws std::invalid_argument that says what is wrong with shape or settings.
  BreakablePanel(const PanelShape& shape, const PanelSettings& settings);
  ~BreakablePanel();
  /// A panel of its own with the same damage.
  BreakablePanel(const BreakablePanel& other);
  /// Moves: what is moved from may only be destroyed or assigned to.
  BreakablePanel(BreakablePanel&&) noexcept;
  BreakablePanel& operator=(const BreakablePanel&) = delete;
  /// Moves, as the constructor does.
  BreakablePanel& operator=(BreakablePanel&&) noexcept;

  /// Breaks every cell whose site (voronoi) or any part (quadrilateral) lies within `radius` of a point, and at least
  /// the one that holds the point when it lies in the panel. With Method::local a radius scales the damage so that its
  /// greatest length is the radius; without one, the lengths are those of the settings. Pieces that no held edge holds
  /// any more leave as well. Throws std::invalid_argument for a point or radius that is not finite, a radius below 0.
  Fracture hit(const Vec2& at, std::optional<double> radius = std::nullopt);

  /// Other edges hold the panel from now on (an entry for each edge of the outline). Pieces that none of them holds
  /// leave.
  Fracture hold(const std::vector<bool>& held);

  /// All that remains leaves, as chunks that nothing holds: what happens to a panel that has come off.
  Fracture leave();

  /// What remains, kept up to date hit by hit at the cost of what changed. Some vertices may be without a triangle
  /// (`compact` drops them).
  [[nodiscard]] const Mesh& mesh() const;
  /// As it was given.
  [[nodiscard]] const PanelShape& shape() const;
  [[nodiscard]] double area() const;                  ///< of what remains, m2
  [[nodiscard]] double intact_area() const;           ///< before the first hit, openings taken off, m2
  [[nodiscard]] bool holds(const Vec2& point) const;  ///< whether the material is still there
  /// Length of an edge of the outline along which the panel is still there, m.
  [[nodiscard]] double intact_length(std::size_t edge) const;
  /// What remains as convex pieces that share borders (`hit` false in all of them); it stays where it is.
  [[nodiscard]] std::vector<Chunk> pieces() const;
  /// Triangles of what remains, panel axes: for moments, loads and element meshes.
  [[nodiscard]] std::vector<std::array<Vec2, 3>> triangles() const;
  /// How many hits there were so far.
  [[nodiscard]] std::uint64_t hits() const;
  /// What comes closer to something than this is joined with it, m: 1e-7 of the panel's size.
  [[nodiscard]] double tolerance() const;
  /// Checks the triangulation behind it. For tests.
  [[nodiscard]] bool valid() const;

  /// All that hits have changed, as bytes for load_state() of the same program.
  void save_state(std::ostream& to) const;
  /// For a panel that was made of the same shape and settings: it is then as the one that was saved, and breaks on like
  /// it to the bit. Throws std::runtime_error where bytes are missing; the panel may then be destroyed only.
  void load_state(std::istream& from);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

/// Mesh of a chunk in panel axes, and its mass properties.
[[nodiscard]] Mesh mesh_of(const Chunk& chunk, double thickness);
[[nodiscard]] MassProperties properties_of(const Chunk& chunk, double thickness, double density);

}  // namespace topple::fracture
