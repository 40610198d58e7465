#include "renderer/shapes/torn_ends.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/vec2.hpp>

namespace topple::viewer {
namespace {

constexpr float bar_radius = 0.010F;  // m
constexpr float cover = 0.05F;        // m, from a member's face to the middle of a bar
constexpr int bar_sides = 5;
constexpr double area_of_bar = 0.04;  // m2 of a torn face

/// Numbers from 0 to 1 that are the same for the same seed (splitmix64: Steele, Lea, Flood 2014).
class Chance {
 public:
  explicit Chance(std::uint64_t seed) : state_(seed) {}
  float next() {
    std::uint64_t word = state_ += 0x9e3779b97f4a7c15U;
    word = (word ^ (word >> 30U)) * 0xbf58476d1ce4e5b9U;
    word = (word ^ (word >> 27U)) * 0x94d049bb133111ebU;
    return static_cast<float>((word ^ (word >> 31U)) >> 40U) / static_cast<float>(1U << 24U);
  }
  /// -1 to 1.
  float side() { return 2 * next() - 1; }

 private:
  std::uint64_t state_;
};

void triangle(Mesh& mesh, const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, float broken) {
  const glm::vec3 across = glm::cross(b - a, c - a);
  const float length = glm::length(across);
  if (!(length > 0)) return;
  for (const glm::vec3& p : {a, b, c}) {
    mesh.indices.push_back(static_cast<std::uint32_t>(mesh.vertices.size()));
    mesh.vertices.push_back({p, across / length, broken});
  }
}

using Ring = std::array<glm::vec3, bar_sides>;

Ring ring_at(const glm::vec3& centre, const glm::vec3& along) {
  const glm::vec3 aside = std::abs(along.z) < 0.9F ? glm::vec3(0, 0, 1) : glm::vec3(1, 0, 0);
  const glm::vec3 u = glm::normalize(glm::cross(aside, along)), v = glm::cross(along, u);
  Ring ring{};
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const float angle = glm::two_pi<float>() * static_cast<float>(i) / bar_sides;
    ring[i] = centre + bar_radius * (std::cos(angle) * u + std::sin(angle) * v);
  }
  return ring;
}

/// A closed tube through three points: straight out of the concrete, then bent.
void bar(Mesh& mesh, const glm::vec3& from, const glm::vec3& out, Chance& chance) {
  const float first = 0.06F + 0.16F * chance.next(), second = 0.05F + 0.35F * chance.next() * chance.next();
  const glm::vec3 bent = glm::normalize(out + 0.9F * glm::vec3(chance.side(), chance.side(), chance.side()));
  const glm::vec3 knee = from + first * out, end = knee + second * bent;
  const std::array<glm::vec3, 3> points{from - 0.03F * out, knee, end};
  // All rings are turned alike, so that the tube does not wring.
  const glm::vec3 along[] = {out, glm::normalize(out + bent), bent};
  std::array<Ring, 3> rings{};
  for (std::size_t k = 0; k < 3; ++k) rings[k] = ring_at(points[k], along[k]);
  for (std::size_t k = 0; k < 2; ++k)
    for (std::size_t i = 0; i < bar_sides; ++i) {
      const std::size_t j = (i + 1) % bar_sides;
      triangle(mesh, rings[k][i], rings[k][j], rings[k + 1][j], bar_mark);
      triangle(mesh, rings[k][i], rings[k + 1][j], rings[k + 1][i], bar_mark);
    }
  for (std::size_t i = 1; i + 1 < bar_sides; ++i) {
    triangle(mesh, rings[0][0], rings[0][i + 1], rings[0][i], bar_mark);
    triangle(mesh, rings[2][0], rings[2][i], rings[2][i + 1], bar_mark);
  }
}

/// A closed body over the section: its foot in x = 0, its head rough.
void rough_face(Mesh& mesh, float width, float depth, Chance& chance) {
  constexpr std::size_t cells = 5;
  using Row = std::array<glm::vec3, cells + 1>;
  std::array<Row, cells + 1> head{}, foot{};
  const float thin = std::min(width, depth);
  for (std::size_t j = 0; j <= cells; ++j)
    for (std::size_t i = 0; i <= cells; ++i) {
      const float s = static_cast<float>(i) / cells, t = static_cast<float>(j) / cells;
      const bool border = i == 0 || j == 0 || i == cells || j == cells;
      // Inner points are not in rows.
      const float aside = border ? 0.0F : 0.3F / cells;
      const glm::vec2 at((s - 0.5F + aside * chance.side()) * width, (t - 0.5F + aside * chance.side()) * depth);
      const float middle = 16 * s * (1 - s) * t * (1 - t);
      const float height = thin * (0.02F + 0.06F * chance.next() + 0.25F * middle * chance.next());
      head[j][i] = {height, at.x, at.y};
      foot[j][i] = {0, at.x, at.y};
    }
  const auto quad = [&](const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, const glm::vec3& d) {
    triangle(mesh, a, b, c, 1);
    triangle(mesh, a, c, d, 1);
  };
  for (std::size_t j = 0; j < cells; ++j)
    for (std::size_t i = 0; i < cells; ++i) {
      quad(head[j][i], head[j][i + 1], head[j + 1][i + 1], head[j + 1][i]);
      quad(foot[j][i], foot[j + 1][i], foot[j + 1][i + 1], foot[j][i + 1]);
    }
  for (std::size_t k = 0; k < cells; ++k) {
    quad(foot[0][k], foot[0][k + 1], head[0][k + 1], head[0][k]);
    quad(foot[cells][k + 1], foot[cells][k], head[cells][k], head[cells][k + 1]);
    quad(foot[k + 1][0], foot[k][0], head[k][0], head[k + 1][0]);
    quad(foot[k][cells], foot[k + 1][cells], head[k + 1][cells], head[k][cells]);
  }
}

}  // namespace

Mesh torn_end_mesh(const structure::Section& section, unsigned variant) {
  constexpr float wide = 0.45F;  // m: bars in the middles of sides from here on
  const auto square = static_cast<float>(std::sqrt(section.area));
  const float width = section.width > 0 ? static_cast<float>(section.width) : square;
  const float depth = section.depth > 0 ? static_cast<float>(section.depth) : square;
  Mesh mesh;
  Chance chance(0x7ea2U + variant);
  rough_face(mesh, width, depth, chance);
  const float y = std::max(width / 2 - cover, 0.25F * width), z = std::max(depth / 2 - cover, 0.25F * depth);
  std::vector<glm::vec2> places{{-y, -z}, {y, -z}, {y, z}, {-y, z}};
  if (depth >= wide) places.insert(places.end(), {{-y, 0}, {y, 0}});
  if (width >= wide) places.insert(places.end(), {{0, -z}, {0, z}});
  for (const glm::vec2& place : places) bar(mesh, {0.02F, place.x, place.y}, {1, 0, 0}, chance);
  return mesh;
}

void add_bars(Mesh& mesh, std::size_t most) {
  const std::size_t own = mesh.indices.size();
  std::size_t added = 0;
  double area = 0;
  for (std::size_t i = 0; i + 2 < own && added < most; i += 3) {
    const std::array<Vertex, 3> corner{mesh.vertices[mesh.indices[i]], mesh.vertices[mesh.indices[i + 1]],
                                       mesh.vertices[mesh.indices[i + 2]]};
    if (std::any_of(corner.begin(), corner.end(), [](const Vertex& v) { return v.broken < 0.5F; })) continue;
    const glm::vec3 across =
        glm::cross(corner[1].position - corner[0].position, corner[2].position - corner[0].position);
    area += static_cast<double>(glm::length(across)) / 2;
    Chance chance(own * 131U + i);
    for (area += 0.5 * area_of_bar * static_cast<double>(chance.side()); area >= area_of_bar && added < most; ++added) {
      area -= area_of_bar;
      const float s = std::sqrt(chance.next()), t = chance.next();
      const glm::vec3 place =
          (1 - s) * corner[0].position + s * (1 - t) * corner[1].position + s * t * corner[2].position;
      bar(mesh, place, glm::normalize(across), chance);
    }
  }
}

}  // namespace topple::viewer
