#include "shapes/polyhedron.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace topple::collision {

namespace {

/// Twice the area of a loop, along its normal by the right-hand rule.
Vec3 loop_area(const std::vector<Vec3>& vertices, const std::vector<int>& loop) {
  Vec3 area = Vec3::Zero();
  const auto at = [&](std::size_t i) -> const Vec3& {
    return vertices[static_cast<std::size_t>(loop[i % loop.size()])];
  };
  for (std::size_t i = 1; i + 1 < loop.size(); ++i) area += (at(i) - at(0)).cross(at(i + 1) - at(0));
  return area;
}

/// Faces of one plane that a search for the hull left in parts become one: its corners in order of angle.
void join_coplanar(const std::vector<Vec3>& vertices, const Vec3& centre, std::vector<std::vector<int>>& loops) {
  constexpr double same = 1e-3;  // difference of unit normals: the search for a hull rounds its corners
  struct Plane {
    Vec3 normal;
    std::set<int> corners;
    std::size_t parts = 0, first = 0;
  };
  std::vector<Plane> planes;
  for (std::size_t i = 0; i < loops.size(); ++i) {
    Vec3 area = loop_area(vertices, loops[i]);
    if (area.norm() == 0) continue;
    if (area.dot(vertices[static_cast<std::size_t>(loops[i].front())] - centre) < 0) area = -area;
    const Vec3 normal = area.normalized();
    auto plane = std::find_if(planes.begin(), planes.end(),
                              [&](const Plane& one) { return (one.normal - normal).norm() < same; });
    if (plane == planes.end()) plane = planes.insert(planes.end(), {normal, {}, 0, i});
    plane->corners.insert(loops[i].begin(), loops[i].end());
    ++plane->parts;
  }
  std::vector<std::vector<int>> joined;
  for (const Plane& plane : planes) {
    if (plane.parts == 1) {
      joined.push_back(loops[plane.first]);
      continue;
    }
    Vec3 middle = Vec3::Zero();
    for (const int corner : plane.corners)
      middle += vertices[static_cast<std::size_t>(corner)] / static_cast<double>(plane.corners.size());
    const Vec3 x = (vertices[static_cast<std::size_t>(*plane.corners.begin())] - middle).normalized(),
               y = plane.normal.cross(x);
    std::vector<int>& loop = joined.emplace_back(plane.corners.begin(), plane.corners.end());
    const auto angle = [&](int corner) {
      const Vec3 arm = vertices[static_cast<std::size_t>(corner)] - middle;
      return std::atan2(arm.dot(y), arm.dot(x));
    };
    std::stable_sort(loop.begin(), loop.end(), [&](int a, int b) { return angle(a) < angle(b); });
  }
  loops = std::move(joined);
}

void add_faces(std::vector<std::vector<int>>& loops, Polyhedron& made) {
  for (std::vector<int>& loop : loops) {
    Vec3 area = loop_area(made.vertices, loop);
    if (area.norm() == 0) continue;
    const Vec3& any = made.vertices[static_cast<std::size_t>(loop.front())];
    if (area.dot(any - made.centre) < 0) {
      std::reverse(loop.begin(), loop.end());
      area = -area;
    }
    Polyhedron::Face face;
    face.normal = area.normalized();
    face.first = static_cast<int>(made.loops.size());
    face.count = static_cast<int>(loop.size());
    face.offset = -1e300;
    double low = 1e300;
    for (const Vec3& vertex : made.vertices) {
      face.offset = std::max(face.offset, face.normal.dot(vertex));
      low = std::min(low, face.normal.dot(vertex));
    }
    made.thickness = made.faces.empty() ? face.offset - low : std::min(made.thickness, face.offset - low);
    made.loops.insert(made.loops.end(), loop.begin(), loop.end());
    made.faces.push_back(face);
  }
}

void add_edges(Polyhedron& made) {
  std::map<std::pair<int, int>, std::size_t> known;  // by the loop that goes the other way
  for (std::size_t f = 0; f < made.faces.size(); ++f) {
    const Polyhedron::Face& face = made.faces[f];
    for (int i = 0; i < face.count; ++i) {
      const int from = made.loops[static_cast<std::size_t>(face.first + i)];
      const int to = made.loops[static_cast<std::size_t>(face.first + (i + 1) % face.count)];
      if (const auto other = known.find({to, from}); other != known.end()) {
        made.edges[other->second].right = static_cast<int>(f);
        continue;
      }
      Polyhedron::Edge edge;
      edge.from = from;
      edge.to = to;
      edge.left = edge.right = static_cast<int>(f);
      edge.direction =
          (made.vertices[static_cast<std::size_t>(to)] - made.vertices[static_cast<std::size_t>(from)]).normalized();
      known.emplace(std::pair(from, to), made.edges.size());
      made.edges.push_back(edge);
    }
  }
}

void measure_edges(Polyhedron& made) {
  for (Polyhedron::Edge& edge : made.edges) {
    const Vec3& from = made.vertices[static_cast<std::size_t>(edge.from)];
    const Vec3 &left = made.faces[static_cast<std::size_t>(edge.left)].normal,
               &right = made.faces[static_cast<std::size_t>(edge.right)].normal;
    edge.left_offset = left.dot(from);
    edge.right_offset = right.dot(from);
    edge.cosine = left.dot(right);
  }
}

}  // namespace

std::shared_ptr<const Polyhedron> make_polyhedron(std::vector<Vec3> vertices, std::vector<std::vector<int>> faces) {
  auto made = std::make_shared<Polyhedron>();
  made->vertices = std::move(vertices);
  for (const Vec3& vertex : made->vertices) {
    made->centre += vertex / static_cast<double>(made->vertices.size());
    made->reach = std::max(made->reach, vertex.norm());
  }
  join_coplanar(made->vertices, made->centre, faces);
  add_faces(faces, *made);
  add_edges(*made);
  measure_edges(*made);
  made->inner = made->reach;
  for (const Polyhedron::Face& face : made->faces)
    made->inner = std::min(made->inner, face.offset - face.normal.dot(made->centre));
  made->inner = std::max(0.0, made->inner);
  return made;
}

std::shared_ptr<const Polyhedron> make_box(const Vec3& half_extents, const Pose& pose) {
  std::vector<Vec3> vertices;
  for (int i = 0; i < 8; ++i)
    vertices.push_back(pose * half_extents.cwiseProduct(Vec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1)));
  return make_polyhedron(std::move(vertices),
                         {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}});
}

}  // namespace topple::collision
