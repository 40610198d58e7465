#pragma once
// Triangle meshes that instances are drawn from. Every mesh is closed and outward oriented (counter-clockwise seen from
// outside), with flat or smooth normals as the shape asks.
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "topple/fracture/mesh.h"
#include "topple/structure/building.h"

namespace topple::viewer {

struct Vertex {
  glm::vec3 position, normal;
  float broken = 0;  ///< 1: of a face where it was torn; bar_mark of torn_ends.h: of a bar that sticks out of it
};
struct Mesh {
  std::vector<Vertex> vertices;
  std::vector<std::uint32_t> indices;
};

/// A member of this section: x from 0 to 1 along the member in `segments` equal parts (so that it can be drawn bent), y
/// and z in the model's length unit, local member axes. A section given by numbers becomes a box of its depth and
/// width, or the square of its area.
[[nodiscard]] Mesh section_mesh(const structure::Section& section, int segments);
/// The same without its ends, which is not closed: what casts shadows where there are many.
[[nodiscard]] Mesh section_tube_mesh(const structure::Section& section);
/// The box around it: what is seen of it from far.
[[nodiscard]] Mesh section_box_mesh(const structure::Section& section);

/// A panel with its openings: x, y in [0, 1] along the panel's first and fourth edge, z in [-1/2, 1/2] across its
/// thickness.
[[nodiscard]] Mesh panel_mesh(const structure::Building& building, const structure::Panel& panel);

/// A piece of a broken panel as it is, or of a model drawn around a building.
[[nodiscard]] Mesh chunk_mesh(const fracture::Mesh& chunk);
/// Marks as broken what does not face the way that most of the mesh's surface does, which is a panel's faces; but not
/// the given panel's own borders and openings, where there is one (positions in the undeformed building).
void mark_broken(Mesh& mesh, const structure::Building* building, const structure::Panel* panel);

/// Radius 1, about the origin.
[[nodiscard]] Mesh sphere_mesh(int rings);

/// From (0, 0, 0) to (0, 0, 1), for arrows: a shaft and a head.
[[nodiscard]] Mesh arrow_mesh(int sides);

}  // namespace topple::viewer
