#pragma once
// The place of a chunk in the panel that it broke out of, and what of a drawn mesh goes with it.
#include <cstdint>
#include <optional>
#include <vector>

#include "topple/fracture/solid_cut.h"
#include "topple/structure/simulation.h"

namespace topple::structure {

struct ChunkPrism {
  std::int64_t body = -1;
  PanelId panel;
  std::vector<Vec2> outline;  ///< convex, counter-clockwise; panel axes from its node 1

  /// The foot of a point (global, undeformed) lies within the outline.
  [[nodiscard]] bool holds(const Building& building, const Vec3& point) const;
  [[nodiscard]] Vec3 centre(const Building& building) const;
};

/// Of a body that is a chunk of a panel; none for any other.
[[nodiscard]] std::optional<ChunkPrism> chunk_prism(const Building& building, const NameIndex& names,
                                                    const BodyView& body);

struct CutOut {
  fracture::Mesh inside;                ///< may be without triangles
  std::vector<fracture::Mesh> outside;  ///< what each cut took off, closed
};
/// What of a closed mesh lies over the chunk, between two heights over the panel's plane.
[[nodiscard]] CutOut cut_out(const fracture::Mesh& mesh, const Building& building, const ChunkPrism& chunk, double low,
                             double high);

/// Height of a point over the panel's plane.
[[nodiscard]] double height_over(const Building& building, PanelId panel, const Vec3& point);

}  // namespace topple::structure
