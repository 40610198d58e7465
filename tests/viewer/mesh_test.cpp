// Every mesh that is drawn is closed and faces outwards: each edge is run through once each way, and the volume
// enclosed (by the divergence theorem) is that of the section, whose area comes from its dimensions by hand.
#include "renderer/shapes/mesh.h"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <map>
#include <tuple>
#include <utility>

#include "renderer/shapes/triangulation.h"

namespace {

using topple::structure::Building;
using topple::structure::NodeId;
using topple::structure::Panel;
using topple::structure::Section;
using topple::viewer::Mesh;
using topple::viewer::panel_mesh;
using topple::viewer::section_mesh;

using Point = std::tuple<long, long, long>;

Point key(const glm::vec3& p) { return {std::lround(1e5 * p.x), std::lround(1e5 * p.y), std::lround(1e5 * p.z)}; }

bool closed(const Mesh& mesh) {
  std::map<std::pair<Point, Point>, int> edges;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3)
    for (std::size_t e = 0; e < 3; ++e) {
      const Point a = key(mesh.vertices[mesh.indices[i + e]].position);
      const Point b = key(mesh.vertices[mesh.indices[i + (e + 1) % 3]].position);
      ++edges[{a, b}];
    }
  for (const auto& [edge, count] : edges) {
    const auto back = edges.find({edge.second, edge.first});
    if (back == edges.end() || back->second != count) return false;
  }
  return !edges.empty();
}

double volume(const Mesh& mesh) {
  double sum = 0;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    const glm::dvec3 a(mesh.vertices[mesh.indices[i]].position), b(mesh.vertices[mesh.indices[i + 1]].position),
        c(mesh.vertices[mesh.indices[i + 2]].position);
    sum += glm::dot(a, glm::cross(b, c)) / 6;
  }
  return sum;
}

/// Does each vertex's normal point to the side that its triangle faces?
bool normals_agree(const Mesh& mesh) {
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    const auto& a = mesh.vertices[mesh.indices[i]];
    const auto& b = mesh.vertices[mesh.indices[i + 1]];
    const auto& c = mesh.vertices[mesh.indices[i + 2]];
    const glm::vec3 face = glm::cross(b.position - a.position, c.position - a.position);
    for (const auto* v : {&a, &b, &c})
      if (std::abs(glm::length(v->normal) - 1) > 1e-4F || glm::dot(face, v->normal) <= 0) return false;
  }
  return true;
}

Section section(Section::Shape shape, double depth, double width) {
  Section s;
  s.shape = shape;
  s.depth = depth;
  s.width = width;
  return s;
}

void check(const Mesh& mesh, double expected_volume, double tolerance) {
  CHECK(closed(mesh));
  CHECK(normals_agree(mesh));
  CHECK(volume(mesh) == Approx(expected_volume).epsilon(tolerance));
}

/// Vertices are single precision.
constexpr double rounding = 1e-5;

}  // namespace

TEST_CASE("an I section is drawn with its flanges and web") {
  Section s = section(Section::Shape::I, 0.4, 0.3);
  s.web = 0.01;
  s.flange = 0.02;
  check(section_mesh(s, 4), 2 * 0.3 * 0.02 + (0.4 - 2 * 0.02) * 0.01, rounding);
}

TEST_CASE("a box section is drawn hollow") {
  Section s = section(Section::Shape::box, 0.4, 0.2);
  s.thickness = 0.02;
  check(section_mesh(s, 3), 0.4 * 0.2 - 0.36 * 0.16, rounding);
}

TEST_CASE("circles and pipes are drawn as polygons inscribed in them") {
  // 24 corners: the area of the inscribed polygon is that of the circle times sin(2 pi/24)/(2 pi/24).
  const double inscribed = std::sin(glm::two_pi<double>() / 24) / (glm::two_pi<double>() / 24);
  check(section_mesh(section(Section::Shape::circle, 0.3, 0.3), 2), inscribed * glm::pi<double>() * 0.15 * 0.15,
        rounding);
  Section pipe = section(Section::Shape::pipe, 0.3, 0.3);
  pipe.thickness = 0.01;
  check(section_mesh(pipe, 2), inscribed * glm::pi<double>() * (0.15 * 0.15 - 0.14 * 0.14), 1e-4);
}

TEST_CASE("a section of numbers is drawn as a box of its size, or the square of its area") {
  Section s = section(Section::Shape::numbers, 0.4, 0.2);
  s.area = 0.05;
  check(section_mesh(s, 1), 0.4 * 0.2, rounding);
  s.depth = s.width = 0;
  check(section_mesh(s, 1), 0.05, rounding);
}

TEST_CASE("a panel is drawn with its openings cut out") {
  Building building;
  const std::array<std::array<double, 3>, 4> corners{{{0, 0, 0}, {6, 0, 0}, {6, 0, 3}, {0, 0, 3}}};
  Panel panel;
  for (std::size_t i = 0; i < 4; ++i) {
    topple::structure::Node node;
    node.position = {corners[i][0], corners[i][1], corners[i][2]};
    building.nodes.push_back(node);
    panel.nodes[i] = NodeId(i);
  }
  // In the mesh's own units the panel is 1 x 1 x 1.
  check(panel_mesh(building, panel), 1, rounding);
  panel.openings = {{{1, 1}, {2, 1}, {2, 2}, {1, 2}}, {{4, 1}, {5, 1}, {4.5, 2.5}}};
  check(panel_mesh(building, panel), 1 - (1.0 + 0.75) / 18, 1e-4);
  panel.openings = {{{1.5, 0}, {2.5, 0}, {2.5, 2.1}, {1.5, 2.1}}};  // a door: its sill is kept off the edge by 1/1000
  check(panel_mesh(building, panel), 1 - 2.1 / 18, 1e-3);
}

TEST_CASE("spheres and arrows are closed") {
  // The inscribed polyhedron of 24 x 48 faces has a little less than the sphere's volume.
  check(topple::viewer::sphere_mesh(24), 4.0 / 3 * glm::pi<double>(), 0.01);
  CHECK(closed(topple::viewer::arrow_mesh(12)));
  CHECK(normals_agree(topple::viewer::arrow_mesh(12)));
}

TEST_CASE("triangles of a polygon with holes cover its area exactly once") {
  using topple::viewer::Loop;
  const Loop outline{{0, 0}, {10, 0}, {10, 4}, {6, 4}, {6, 8}, {10, 8}, {10, 12}, {0, 12}};
  const std::vector<Loop> holes{{{1, 1}, {3, 1}, {3, 3}, {1, 3}}, {{1, 6}, {1, 9}, {4, 9}, {4, 6}}};
  std::vector<glm::vec2> points = outline;
  for (const Loop& hole : holes) points.insert(points.end(), hole.begin(), hole.end());
  double area = 0;
  for (const auto& t : topple::viewer::triangulate(outline, holes)) {
    const glm::vec2 a = points[static_cast<std::size_t>(t[0])], b = points[static_cast<std::size_t>(t[1])],
                    c = points[static_cast<std::size_t>(t[2])];
    const double part = ((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)) / 2;
    CHECK(part >= 0);
    area += part;
  }
  CHECK(area == Approx(10 * 12 - 4 * 4 - 2 * 2 - 3 * 3));
}

TEST_CASE("where there are many members, simpler shapes of the same size stand for them") {
  Section section;
  section.shape = Section::Shape::I;
  section.depth = 0.4, section.width = 0.2, section.web = 0.01, section.flange = 0.02;
  section.area = 0.2 * 0.04 + 0.36 * 0.01;
  const Mesh full = section_mesh(section, 1), tube = topple::viewer::section_tube_mesh(section),
             box = topple::viewer::section_box_mesh(section);
  const auto reach = [](const Mesh& mesh) {
    glm::vec3 most(0);
    for (const auto& v : mesh.vertices) most = glm::max(most, glm::abs(v.position));
    return most;
  };
  CHECK(reach(tube) == reach(full));
  CHECK(reach(box) == reach(full));
  CHECK(tube.indices.size() < full.indices.size());
  CHECK(closed(box));
  CHECK(volume(box) == Approx(0.4 * 0.2));
  CHECK(box.indices.size() == 36);
}
