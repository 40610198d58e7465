#include "panel_mesh.h"

#include "side_face.h"

namespace topple::fracture {

int PanelMesh::new_vertices(std::size_t count) {
  const auto first = static_cast<int>(mesh_.positions.size());
  const std::size_t size = mesh_.positions.size() + count;
  mesh_.positions.resize(size, Vec3::Zero());
  mesh_.normals.resize(size, Vec3::UnitZ());
  mesh_.texture.resize(size, Vec2::Zero());
  return first;
}

int PanelMesh::corner_pair(const HalfEdges& triangulation, int vertex) {
  if (pairs_.size() <= index(vertex)) pairs_.resize(index(vertex) + 1, none);
  int& first = pairs_[index(vertex)];
  if (first == none) first = new_vertices(2);
  // A number may have been given to another point since.
  const Vec2& point = triangulation.point(vertex);
  for (int upper = 0; upper < 2; ++upper) {
    mesh_.positions[index(first + upper)] = Vec3(point.x(), point.y(), (upper ? 1 : -1) * thickness_ / 2);
    mesh_.normals[index(first + upper)] = Vec3(0, 0, upper ? 1 : -1);
    mesh_.texture[index(first + upper)] = point;
  }
  return first;
}

int PanelMesh::side_vertices() {
  if (free_sides_.empty()) return new_vertices(4);
  const int first = free_sides_.back();
  free_sides_.pop_back();
  return first;
}

void PanelMesh::add_face(int triangle, std::size_t face, const std::array<int, 3>& corners) {
  faces_[index(triangle)][face] = static_cast<int>(mesh_.triangles.size());
  owners_.push_back({triangle, static_cast<int>(face)});
  mesh_.triangles.push_back(corners);
}

void PanelMesh::remove(int triangle) {
  for (int& place : faces_[index(triangle)]) {
    if (place == none) continue;
    const auto [owner, face] = owners_.back();
    mesh_.triangles[index(place)] = mesh_.triangles.back();
    owners_[index(place)] = owners_.back();
    faces_[index(owner)][index(face)] = place;
    mesh_.triangles.pop_back();
    owners_.pop_back();
    place = none;
  }
  for (int& first : sides_[index(triangle)]) {
    if (first != none) free_sides_.push_back(first);
    first = none;
  }
}

void PanelMesh::add(const HalfEdges& triangulation, int triangle, int intact) {
  std::array<int, 3> lower{};
  for (int i = 0; i < 3; ++i)
    lower[index(i)] = corner_pair(triangulation, triangulation.origin(HalfEdges::half(triangle, i)));
  add_face(triangle, 0, {lower[0] + 1, lower[1] + 1, lower[2] + 1});
  add_face(triangle, 1, {lower[0], lower[2], lower[1]});
  for (int i = 0; i < 3; ++i) {
    const int edge = HalfEdges::half(triangle, i), twin = triangulation.twin(edge);
    if (twin != HalfEdges::none && triangulation.label(HalfEdges::triangle_of(twin)) == intact) continue;
    const int first = side_vertices();
    sides_[index(triangle)][index(i)] = first;
    const auto two = write_side(mesh_, first, triangulation.point(triangulation.origin(edge)),
                                triangulation.point(triangulation.target(edge)), thickness_);
    add_face(triangle, 2 + 2 * index(i), two[0]);
    add_face(triangle, 3 + 2 * index(i), two[1]);
  }
}

void PanelMesh::update(const HalfEdges& triangulation, const std::vector<int>& triangles, int intact) {
  std::array<int, kFaces> no_faces{};
  no_faces.fill(none);
  faces_.resize(index(triangulation.triangle_slots()), no_faces);
  sides_.resize(faces_.size(), {none, none, none});
  // A triangle beside a changed one may gain or lose a side.
  std::vector<int> all = triangles;
  std::vector<char> listed(faces_.size(), 0);
  for (const int triangle : triangles) listed[index(triangle)] = 1;
  for (const int triangle : triangles)
    for (const int edge : HalfEdges::sides(triangle)) {
      const int twin = triangulation.alive(triangle) ? triangulation.twin(edge) : HalfEdges::none;
      if (twin == HalfEdges::none || listed[index(HalfEdges::triangle_of(twin))]) continue;
      listed[index(HalfEdges::triangle_of(twin))] = 1;
      all.push_back(HalfEdges::triangle_of(twin));
    }
  for (const int triangle : all) remove(triangle);
  for (const int triangle : all)
    if (triangulation.alive(triangle) && triangulation.label(triangle) == intact) add(triangulation, triangle, intact);
}

}  // namespace topple::fracture
