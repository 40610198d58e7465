#include "topple/fracture/mesh.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <tuple>

#include "weld.h"

namespace topple::fracture {

std::vector<int> weld(const std::vector<Vec3>& positions) {
  std::vector<int> order(positions.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<int>(i);
  const auto key = [&](int i) {
    const Vec3& p = positions[static_cast<std::size_t>(i)];
    return std::make_tuple(p.x(), p.y(), p.z());
  };
  std::sort(order.begin(), order.end(), [&](int a, int b) { return key(a) < key(b); });
  std::vector<int> number(positions.size());
  int next = -1;
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (i == 0 || key(order[i]) != key(order[i - 1])) ++next;
    number[static_cast<std::size_t>(order[i])] = next;
  }
  return number;
}

namespace {

struct DirectedEdge {
  int low, high;
  bool forward;
  auto operator<=>(const DirectedEdge&) const = default;
};

void count_edges(const Mesh& mesh, MeshAudit& result) {
  const std::vector<int> number = weld(mesh.positions);
  std::vector<DirectedEdge> edges;
  for (const auto& triangle : mesh.triangles)
    for (std::size_t i = 0; i < 3; ++i) {
      const int a = number[static_cast<std::size_t>(triangle[i])];
      const int b = number[static_cast<std::size_t>(triangle[(i + 1) % 3])];
      edges.push_back({std::min(a, b), std::max(a, b), a < b});
    }
  std::sort(edges.begin(), edges.end());
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t end = i, forward = 0;
    for (; end < edges.size() && edges[end].low == edges[i].low && edges[end].high == edges[i].high; ++end)
      forward += edges[end].forward ? 1 : 0;
    if (2 * forward != end - i)
      ++result.open_edges;
    else if (forward > 1)
      ++result.touching_edges;
    i = end;
  }
}

}  // namespace

std::string MeshAudit::text() const {
  std::ostringstream out;
  out << open_edges << " open edges, " << touching_edges << " touching edges, " << degenerate_triangles
      << " degenerate triangles, " << wrong_normals << " wrong normals, volume " << volume << " m3";
  return out.str();
}

MeshAudit audit(const Mesh& mesh, double least_height, bool smooth) {
  MeshAudit result;
  const Vec3 base = mesh.positions.empty() ? Vec3::Zero() : mesh.positions.front();
  const double least_cosine = smooth ? 0.0 : std::cos(1e-3);
  for (const auto& triangle : mesh.triangles) {
    const auto corner = [&](std::size_t i) -> const Vec3& {
      return mesh.positions[static_cast<std::size_t>(triangle[i])];
    };
    const Vec3 a = corner(1) - corner(0), b = corner(2) - corner(0);
    const Vec3 doubled = a.cross(b);
    const double longest = std::max({a.norm(), b.norm(), (b - a).norm()});
    result.area += doubled.norm() / 2;
    result.volume += (corner(0) - base).dot(doubled) / 6;
    if (!(doubled.norm() >= least_height * longest && longest > 0)) {
      ++result.degenerate_triangles;
      continue;
    }
    for (const int vertex : triangle) {
      const Vec3& normal = mesh.normals[static_cast<std::size_t>(vertex)];
      if (!(std::abs(normal.norm() - 1) < 1e-9 && normal.dot(doubled) >= least_cosine * doubled.norm()))
        ++result.wrong_normals;
    }
  }
  count_edges(mesh, result);
  return result;
}

Mesh compact(const Mesh& mesh) {
  Mesh result;
  std::vector<int> number(mesh.positions.size(), -1);
  for (auto triangle : mesh.triangles) {
    for (int& vertex : triangle) {
      const auto old = static_cast<std::size_t>(vertex);
      if (number[old] < 0) {
        number[old] = static_cast<int>(result.positions.size());
        result.positions.push_back(mesh.positions[old]);
        result.normals.push_back(mesh.normals[old]);
        result.texture.push_back(mesh.texture[old]);
      }
      vertex = number[old];
    }
    result.triangles.push_back(triangle);
  }
  return result;
}

}  // namespace topple::fracture
