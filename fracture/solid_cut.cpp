#include "topple/fracture/solid_cut.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <stdexcept>

#include "cap.h"
#include "weld.h"

namespace topple::fracture {

namespace {

std::size_t index(int i) { return static_cast<std::size_t>(i); }

/// One side of a cut while it is made: its mesh, and of each vertex the number of its position.
struct Side {
  Mesh mesh;
  std::vector<int> position;                    ///< welded number of each vertex
  std::map<std::array<int, 2>, int> vertex_of;  ///< by the one or two vertices of the uncut mesh that it comes from
};

class Cutter {
 public:
  Cutter(const Mesh& mesh, const Plane& plane, double tolerance)
      : mesh_(mesh), normal_(plane.normal.normalized()), welded_(weld(mesh.positions)) {
    if (!normal_.allFinite() || !plane.point.allFinite()) throw std::invalid_argument("cut: the plane is not finite");
    for (const Vec3& position : mesh.positions) {
      const double height = normal_.dot(position - plane.point);
      if (!std::isfinite(height)) throw std::invalid_argument("cut: a position is not finite");
      heights_.push_back(std::abs(height) <= tolerance ? 0.0 : height);
    }
    for (const int number : welded_) positions_ = std::max(positions_, number + 1);
    across_ = normal_.unitOrthogonal();
    along_ = normal_.cross(across_);
  }

  CutSolid run() {
    Side below, above;
    for (const auto& triangle : mesh_.triangles) {
      const double lowest = std::min({height(triangle[0]), height(triangle[1]), height(triangle[2])});
      const double highest = std::max({height(triangle[0]), height(triangle[1]), height(triangle[2])});
      if (lowest == 0 && highest == 0) {  // in the plane: a face of the part on its inner side
        add(faces_up(triangle) ? below : above, triangle);
        continue;
      }
      if (highest <= 0) add(below, triangle);
      if (lowest >= 0) add(above, triangle);
      if (lowest < 0 && highest > 0) {
        clip(below, triangle, -1);
        clip(above, triangle, 1);
      }
    }
    close(below, normal_);
    close(above, -normal_);
    return {std::move(below.mesh), std::move(above.mesh)};
  }

 private:
  [[nodiscard]] double height(int vertex) const { return heights_[index(vertex)]; }

  [[nodiscard]] bool faces_up(const std::array<int, 3>& t) const {
    const Vec3 &a = mesh_.positions[index(t[0])], &b = mesh_.positions[index(t[1])], &c = mesh_.positions[index(t[2])];
    return (b - a).cross(c - a).dot(normal_) > 0;
  }

  int vertex(Side& side, int original) {
    const auto [found, is_new] =
        side.vertex_of.try_emplace({original, original}, static_cast<int>(side.position.size()));
    if (is_new) {
      side.mesh.positions.push_back(mesh_.positions[index(original)]);
      side.mesh.normals.push_back(mesh_.normals[index(original)]);
      side.mesh.texture.push_back(mesh_.texture[index(original)]);
      side.position.push_back(welded_[index(original)]);
    }
    return found->second;
  }

  /// Where an edge passes through the plane; the same bits for both triangles at the edge and both parts of the solid,
  /// because it is always computed from the end whose position has the lower number.
  int crossing(Side& side, int a, int b) {
    if (welded_[index(a)] > welded_[index(b)]) std::swap(a, b);
    const auto [found, is_new] = side.vertex_of.try_emplace({a, b}, static_cast<int>(side.position.size()));
    if (!is_new) return found->second;
    const double share = height(a) / (height(a) - height(b));
    side.mesh.positions.push_back(mesh_.positions[index(a)] +
                                  share * (mesh_.positions[index(b)] - mesh_.positions[index(a)]));
    side.mesh.normals.push_back(((1 - share) * mesh_.normals[index(a)] + share * mesh_.normals[index(b)]).normalized());
    side.mesh.texture.push_back((1 - share) * mesh_.texture[index(a)] + share * mesh_.texture[index(b)]);
    const std::array<int, 2> edge{welded_[index(a)], welded_[index(b)]};
    side.position.push_back(
        crossing_number_.try_emplace(edge, positions_ + static_cast<int>(crossing_number_.size())).first->second);
    return found->second;
  }

  void add(Side& side, const std::array<int, 3>& triangle) {
    side.mesh.triangles.push_back({vertex(side, triangle[0]), vertex(side, triangle[1]), vertex(side, triangle[2])});
  }

  /// The part of a triangle below (-1) or above (1) the plane.
  void clip(Side& side, const std::array<int, 3>& triangle, int sign) {
    std::vector<int> kept;
    for (std::size_t i = 0; i < 3; ++i) {
      const int a = triangle[i], b = triangle[(i + 1) % 3];
      if (sign * height(a) >= 0) kept.push_back(vertex(side, a));
      if (height(a) * height(b) < 0) kept.push_back(crossing(side, a, b));
    }
    for (std::size_t i = 1; i + 1 < kept.size(); ++i) side.mesh.triangles.push_back({kept[0], kept[i], kept[i + 1]});
  }

  void close(Side& side, const Vec3& outwards) {
    std::vector<std::array<int, 3>> welded;
    for (const auto& t : side.mesh.triangles)
      welded.push_back({side.position[index(t[0])], side.position[index(t[1])], side.position[index(t[2])]});
    const std::vector<std::array<int, 2>> edges = lid_edges(welded);
    if (edges.empty()) return;
    std::map<int, int> some_vertex;
    for (std::size_t i = 0; i < side.position.size(); ++i) some_vertex.emplace(side.position[i], static_cast<int>(i));
    // Axes in which the lid's inside lies on the left of its edges, seen from outside.
    const Vec3 second = outwards.dot(normal_) > 0 ? along_ : Vec3(-along_);
    std::map<int, int> number;
    std::vector<Vec2> points;
    std::vector<int> vertices;
    std::vector<std::array<int, 2>> border;
    const auto point = [&](int position) {
      const auto [found, is_new] = number.try_emplace(position, static_cast<int>(points.size()));
      if (is_new) {
        const Vec3 place = side.mesh.positions[index(some_vertex.at(position))];
        points.emplace_back(across_.dot(place), second.dot(place));
        vertices.push_back(static_cast<int>(side.mesh.positions.size()));
        side.mesh.positions.push_back(place);
        side.mesh.normals.push_back(outwards);
        side.mesh.texture.emplace_back(across_.dot(place), along_.dot(place));
      }
      return found->second;
    };
    for (const auto& edge : edges) {
      const int from = point(edge[0]), to = point(edge[1]);
      border.push_back({from, to});
    }
    for (const auto& t : lid(points, border))
      side.mesh.triangles.push_back({vertices[index(t[0])], vertices[index(t[1])], vertices[index(t[2])]});
  }

  const Mesh& mesh_;
  Vec3 normal_, across_, along_;
  std::vector<int> welded_;
  int positions_ = 0;
  std::map<std::array<int, 2>, int> crossing_number_;  ///< by the welded ends of the edge
  std::vector<double> heights_;
};

}  // namespace

CutSolid cut(const Mesh& mesh, const Plane& plane, double tolerance) { return Cutter(mesh, plane, tolerance).run(); }

std::vector<Mesh> connected_parts(const Mesh& mesh) {
  const std::vector<int> welded = weld(mesh.positions);
  std::vector<int> parent(mesh.positions.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](int i) {
    while (parent[index(i)] != i) i = parent[index(i)] = parent[index(parent[index(i)])];
    return i;
  };
  for (const auto& t : mesh.triangles)
    for (std::size_t i = 1; i < 3; ++i) {
      const int a = root(welded[index(t[0])]), b = root(welded[index(t[i])]);
      parent[index(std::max(a, b))] = std::min(a, b);
    }
  std::map<int, std::size_t> part_of;
  std::vector<Mesh> parts;
  for (const auto& t : mesh.triangles) {
    const auto [found, is_new] = part_of.try_emplace(root(welded[index(t[0])]), parts.size());
    if (is_new) {
      parts.emplace_back(mesh);
      parts.back().triangles.clear();
    }
    parts[found->second].triangles.push_back(t);
  }
  for (Mesh& part : parts) part = compact(part);
  return parts;
}

MassProperties solid_properties(const Mesh& mesh, double density) {
  MassProperties result;
  if (mesh.triangles.empty()) return result;
  // About the first position, so that a solid far from the origin loses no digits. The integral of p p^T over the
  // tetrahedron 0, a, b, c is (a a^T + b b^T + c c^T + s s^T) V / 20, s = a + b + c.
  const Vec3 base = mesh.positions[index(mesh.triangles[0][0])];
  Vec3 first = Vec3::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  for (const auto& t : mesh.triangles) {
    const Vec3 a = mesh.positions[index(t[0])] - base, b = mesh.positions[index(t[1])] - base,
               c = mesh.positions[index(t[2])] - base, sum = a + b + c;
    const double part = a.dot(b.cross(c)) / 6;
    result.volume += part;
    first += part / 4 * sum;
    second += part / 20 * (a * a.transpose() + b * b.transpose() + c * c.transpose() + sum * sum.transpose());
  }
  result.mass = density * result.volume;
  const Vec3 middle = first / result.volume;
  result.centre = base + middle;
  const Eigen::Matrix3d about = density * (second - result.volume * middle * middle.transpose());
  result.inertia = about.trace() * Eigen::Matrix3d::Identity() - about;
  return result;
}

}  // namespace topple::fracture
