#include "renderer/shapes/mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <utility>
#include <vector>

#include "renderer/shapes/triangulation.h"

namespace topple::viewer {
namespace {

using structure::Section;

struct Profile {
  Loop outline;
  std::vector<Loop> holes;
  bool round = false;  ///< normals run smoothly round it
};

Loop rectangle(float width, float depth) {
  const float y = width / 2, z = depth / 2;
  return {{-y, -z}, {y, -z}, {y, z}, {-y, z}};
}
Loop circle(float diameter, int sides) {
  Loop loop;
  for (int i = 0; i < sides; ++i) {
    const float angle = glm::two_pi<float>() * static_cast<float>(i) / static_cast<float>(sides);
    loop.emplace_back(diameter / 2 * std::cos(angle), diameter / 2 * std::sin(angle));
  }
  return loop;
}
Loop i_shape(const Section& s) {
  const auto y = static_cast<float>(s.width / 2), z = static_cast<float>(s.depth / 2);
  const auto web = static_cast<float>(s.web / 2), inner = static_cast<float>(s.depth / 2 - s.flange);
  return {{-y, -z}, {y, -z}, {y, -inner}, {web, -inner}, {web, inner},   {y, inner},
          {y, z},   {-y, z}, {-y, inner}, {-web, inner}, {-web, -inner}, {-y, -inner}};
}

Profile profile_of(const Section& s) {
  constexpr int sides = 24;
  const auto width = static_cast<float>(s.width), depth = static_cast<float>(s.depth);
  const auto wall = static_cast<float>(2 * s.thickness);
  switch (s.shape) {
    case Section::Shape::I:
      return {i_shape(s), {}, false};
    case Section::Shape::box:
      return {rectangle(width, depth), {rectangle(width - wall, depth - wall)}, false};
    case Section::Shape::rectangle:
      return {rectangle(width, depth), {}, false};
    case Section::Shape::circle:
      return {circle(depth, sides), {}, true};
    case Section::Shape::pipe:
      return {circle(depth, sides), {circle(depth - wall, sides)}, true};
    case Section::Shape::numbers:
      break;
  }
  const auto side = static_cast<float>(std::sqrt(s.area));
  return {width > 0 && depth > 0 ? rectangle(width, depth) : rectangle(side, side), {}, false};
}

glm::vec2 outward(glm::vec2 edge) { return glm::normalize(glm::vec2(edge.y, -edge.x)); }

/// Extrudes plane loops along an axis; `place` puts plane point and height into space.
template <class Place>
class Extrusion {
 public:
  Extrusion(Mesh& mesh, Place place) : mesh_(mesh), place_(place) {}

  /// Side of a loop that has the material on its left.
  void side(const Loop& loop, bool round, int segments, float low, float high) {
    const std::size_t n = loop.size();
    for (std::size_t i = 0; i < n; ++i) {
      const glm::vec2 a = loop[i], b = loop[(i + 1) % n];
      const glm::vec2 here = outward(b - a);
      const glm::vec2 before = round ? glm::normalize(here + outward(a - loop[(i + n - 1) % n])) : here;
      const glm::vec2 after = round ? glm::normalize(here + outward(loop[(i + 2) % n] - b)) : here;
      for (int k = 0; k < segments; ++k) {
        const float h0 = low + (high - low) * static_cast<float>(k) / static_cast<float>(segments);
        const float h1 = low + (high - low) * static_cast<float>(k + 1) / static_cast<float>(segments);
        quad({place_(a, h0), place_(before, 0)}, {place_(b, h0), place_(after, 0)}, {place_(b, h1), place_(after, 0)},
             {place_(a, h1), place_(before, 0)});
      }
    }
  }

  void cap(const Loop& outline, const std::vector<Loop>& holes, float height, bool upwards) {
    const glm::vec3 normal = place_({0, 0}, upwards ? 1.0F : -1.0F);
    const auto first = static_cast<std::uint32_t>(mesh_.vertices.size());
    const auto add = [&](const Loop& loop) {
      for (const glm::vec2 p : loop) mesh_.vertices.push_back({place_(p, height), normal});
    };
    add(outline);
    for (const Loop& hole : holes) add(hole);
    for (const auto& t : triangulate(outline, holes)) {
      const auto a = first + static_cast<std::uint32_t>(t[0]), b = first + static_cast<std::uint32_t>(t[1]),
                 c = first + static_cast<std::uint32_t>(t[2]);
      mesh_.indices.insert(mesh_.indices.end(), {a, upwards ? b : c, upwards ? c : b});
    }
  }

 private:
  void quad(const Vertex& a, const Vertex& b, const Vertex& c, const Vertex& d) {
    const auto first = static_cast<std::uint32_t>(mesh_.vertices.size());
    mesh_.vertices.insert(mesh_.vertices.end(), {a, b, c, d});
    mesh_.indices.insert(mesh_.indices.end(), {first, first + 1, first + 2, first, first + 2, first + 3});
  }
  Mesh& mesh_;
  Place place_;
};

template <class Place>
void extrude(Mesh& mesh, const Profile& profile, int segments, float low, float high, Place place,
             bool with_ends = true) {
  Extrusion<Place> extrusion(mesh, place);
  Loop outline = profile.outline;
  if (doubled_area(outline) < 0) std::reverse(outline.begin(), outline.end());
  extrusion.side(outline, profile.round, segments, low, high);
  for (Loop hole : profile.holes) {
    if (doubled_area(hole) > 0) std::reverse(hole.begin(), hole.end());
    extrusion.side(hole, profile.round, segments, low, high);
  }
  if (!with_ends) return;
  extrusion.cap(outline, profile.holes, low, false);
  extrusion.cap(outline, profile.holes, high, true);
}

/// Surface of revolution about z from a profile (radius, height) that starts and ends on the axis, bottom first.
Mesh revolve(const std::vector<glm::vec2>& profile, int sides, bool smooth) {
  Mesh mesh;
  const auto point = [&](std::size_t i, int k) {
    const float angle = glm::two_pi<float>() * static_cast<float>(k % sides) / static_cast<float>(sides);
    return glm::vec3(profile[i].x * std::cos(angle), profile[i].x * std::sin(angle), profile[i].y);
  };
  const auto triangle = [&](glm::vec3 a, glm::vec3 b, glm::vec3 c) {
    const glm::vec3 flat = glm::normalize(glm::cross(b - a, c - a));
    for (const glm::vec3 p : {a, b, c}) {
      mesh.indices.push_back(static_cast<std::uint32_t>(mesh.vertices.size()));
      mesh.vertices.push_back({p, smooth ? glm::normalize(p) : flat});
    }
  };
  for (std::size_t i = 0; i + 1 < profile.size(); ++i)
    for (int k = 0; k < sides; ++k) {
      if (profile[i].x > 0) triangle(point(i, k), point(i, k + 1), point(i + 1, k + (profile[i + 1].x > 0 ? 1 : 0)));
      if (profile[i + 1].x > 0) triangle(point(i, k), point(i + 1, k + 1), point(i + 1, k));
    }
  return mesh;
}

}  // namespace

Mesh section_mesh(const Section& section, int segments) {
  Mesh mesh;
  // Plane (y, z), height x: y, z, x is right-handed, so counter-clockwise stays outward.
  extrude(mesh, profile_of(section), segments, 0, 1, [](glm::vec2 p, float x) { return glm::vec3(x, p.x, p.y); });
  return mesh;
}

Mesh section_tube_mesh(const Section& section) {
  Mesh mesh;
  Profile profile = profile_of(section);
  profile.holes.clear();
  extrude(
      mesh, profile, 1, 0, 1, [](glm::vec2 p, float x) { return glm::vec3(x, p.x, p.y); }, false);
  return mesh;
}

Mesh section_box_mesh(const Section& section) {
  Section box;
  box.shape = Section::Shape::rectangle;
  const double square = std::sqrt(section.area);
  box.depth = section.depth > 0 ? section.depth : square;
  const bool is_round = section.shape == Section::Shape::circle || section.shape == Section::Shape::pipe;
  box.width = section.width > 0 && !is_round ? section.width : is_round ? box.depth : square;
  return section_mesh(box, 1);
}

Mesh panel_mesh(const structure::Building& building, const structure::Panel& panel) {
  const auto length = [&](int i, int j) {
    return (building[panel.nodes[static_cast<std::size_t>(j)]].position -
            building[panel.nodes[static_cast<std::size_t>(i)]].position)
        .norm();
  };
  const double along_x = length(0, 1), along_y = length(0, 3);
  Profile profile;
  profile.outline = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  for (const auto& opening : panel.openings) {
    Loop hole;
    // Kept off the border by a hair, so that a door's sill does not coincide with the panel's edge.
    constexpr double border = 1e-3;
    for (const auto& p : opening)
      hole.emplace_back(std::clamp(p.x() / along_x, border, 1 - border),
                        std::clamp(p.y() / along_y, border, 1 - border));
    profile.holes.push_back(std::move(hole));
  }
  Mesh mesh;
  extrude(mesh, profile, 1, -0.5F, 0.5F, [](glm::vec2 p, float z) { return glm::vec3(p.x, p.y, z); });
  return mesh;
}

Mesh chunk_mesh(const fracture::Mesh& chunk) {
  Mesh mesh;
  for (std::size_t i = 0; i < chunk.positions.size(); ++i) {
    const Eigen::Vector3f p = chunk.positions[i].cast<float>(), n = chunk.normals[i].cast<float>();
    mesh.vertices.push_back({{p.x(), p.y(), p.z()}, {n.x(), n.y(), n.z()}});
  }
  for (const auto& triangle : chunk.triangles)
    for (const int corner : triangle) mesh.indices.push_back(static_cast<std::uint32_t>(corner));
  return mesh;
}

namespace {

/// The direction (or its opposite) that the largest area of a mesh of flat faces looks.
glm::vec3 main_direction(const Mesh& mesh) {
  std::vector<std::pair<glm::vec3, float>> directions;
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const Vertex &a = mesh.vertices[mesh.indices[i]], &b = mesh.vertices[mesh.indices[i + 1]],
                 &c = mesh.vertices[mesh.indices[i + 2]];
    const float area = glm::length(glm::cross(b.position - a.position, c.position - a.position));
    const auto same = std::find_if(directions.begin(), directions.end(), [&](const auto& known) {
      return std::abs(glm::dot(known.first, a.normal)) > 0.999F;
    });
    if (same == directions.end())
      directions.emplace_back(a.normal, area);
    else
      same->second += area;
  }
  const auto most = std::max_element(directions.begin(), directions.end(),
                                     [](const auto& a, const auto& b) { return a.second < b.second; });
  return most == directions.end() ? glm::vec3(0, 0, 1) : most->first;
}

/// Where a panel ended before anything broke: its border and its openings, in the undeformed building.
std::vector<std::array<Eigen::Vector3d, 2>> own_edges(const structure::Building& building,
                                                      const structure::Panel& panel) {
  std::vector<std::array<Eigen::Vector3d, 2>> edges;
  const auto corner = [&](std::size_t i) -> const Eigen::Vector3d& { return building[panel.nodes[i % 4]].position; };
  for (std::size_t i = 0; i < 4; ++i) edges.push_back({corner(i), corner(i + 1)});
  const Eigen::Vector3d x = (corner(1) - corner(0)).normalized();
  const Eigen::Vector3d normal = x.cross(corner(3) - corner(0)).normalized(), y = normal.cross(x);
  for (const auto& opening : panel.openings)
    for (std::size_t i = 0; i < opening.size(); ++i) {
      const auto &a = opening[i], &b = opening[(i + 1) % opening.size()];
      edges.push_back({corner(0) + a.x() * x + a.y() * y, corner(0) + b.x() * x + b.y() * y});
    }
  return edges;
}

}  // namespace

void mark_broken(Mesh& mesh, const structure::Building* building, const structure::Panel* panel) {
  const glm::vec3 across = main_direction(mesh);
  const Eigen::Vector3d normal(across.x, across.y, across.z);
  std::vector<std::array<Eigen::Vector3d, 2>> edges;
  if (panel != nullptr) edges = own_edges(*building, *panel);
  for (Vertex& v : mesh.vertices) {
    if (std::abs(glm::dot(v.normal, across)) > 0.9F) continue;
    const Eigen::Vector3d at(v.position.x, v.position.y, v.position.z), facing(v.normal.x, v.normal.y, v.normal.z);
    const bool own = std::any_of(edges.begin(), edges.end(), [&](const auto& edge) {
      const Eigen::Vector3d out = normal.cross(edge[1] - edge[0]).normalized();
      return std::abs(out.dot(at - edge[0])) < 2e-3 && std::abs(out.dot(facing)) > 0.99;
    });
    v.broken = own ? 0.0F : 1.0F;
  }
}

Mesh sphere_mesh(int rings) {
  std::vector<glm::vec2> profile;
  for (int i = 0; i <= rings; ++i) {
    const float angle = glm::pi<float>() * static_cast<float>(i) / static_cast<float>(rings);
    profile.emplace_back(i == 0 || i == rings ? 0.0F : std::sin(angle), -std::cos(angle));
  }
  return revolve(profile, 2 * rings, true);
}

Mesh arrow_mesh(int sides) {
  return revolve({{0, 0}, {0.04F, 0}, {0.04F, 0.72F}, {0.12F, 0.72F}, {0, 1}}, sides, false);
}

}  // namespace topple::viewer
