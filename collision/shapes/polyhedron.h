#pragma once
// A convex polyhedron as the search for contacts reads it: plain arrays, outward faces, edges with the two faces that
// meet in them.
#include <memory>
#include <vector>

#include "topple/collision/world.h"

namespace topple::collision {

struct Polyhedron {
  /// n x <= offset for every point inside; its corners go round counter-clockwise, seen from outside.
  struct Face {
    Vec3 normal;
    double offset = 0;
    int first = 0, count = 0;  ///< of `loops`
  };
  struct Edge {
    int from = 0, to = 0;                      ///< vertices
    int left = 0, right = 0;                   ///< faces: the one whose loop goes from -> to, and the other
    Vec3 direction;                            ///< unit
    double left_offset = 0, right_offset = 0;  ///< the edge along the normals of the two, m
    double cosine = 1;                         ///< between these normals
  };
  std::vector<Vec3> vertices;
  std::vector<Face> faces;
  std::vector<int> loops;
  std::vector<Edge> edges;
  Vec3 centre = Vec3::Zero();  ///< mean of the vertices
  double inner = 0;            ///< radius of a ball about the centre that lies inside, m
  double reach = 0;            ///< no point is farther from the frame's origin, m
  double thickness = 0;        ///< least width across any of its faces, m
};

/// From vertices and outward faces given as loops of vertex numbers (either way round). Planes are laid through the
/// outermost vertex, so that no vertex is outside.
[[nodiscard]] std::shared_ptr<const Polyhedron> make_polyhedron(std::vector<Vec3> vertices,
                                                                std::vector<std::vector<int>> faces);

/// A part as the search for contacts sees it, in its solid's frame: a polyhedron, or a ball where there is none.
struct PartShape {
  std::shared_ptr<const Polyhedron> polyhedron;
  Vec3 centre = Vec3::Zero();  ///< of its bounds
  Vec3 half = Vec3::Zero();    ///< half the size of its bounds
  double radius = 0;           ///< ball
};

/// A box with these half extents about the origin of `pose`.
[[nodiscard]] std::shared_ptr<const Polyhedron> make_box(const Vec3& half_extents, const Pose& pose);

}  // namespace topple::collision
