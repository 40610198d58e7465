#pragma once
// Random panels and sequences of hits on them, of every kind that a careless hand can aim: the same for the tests and
// for the long run of scripts/stress.
#include <cmath>
#include <limits>
#include <optional>
#include <random>
#include <string>

#include "topple/fracture/panel.h"

namespace topple::fracture::test {

struct Sequence {
  PanelShape shape;
  PanelSettings settings;
  std::mt19937 random;

  double unit() { return static_cast<double>(random()) / 4294967296.0; }
};

inline Sequence random_sequence(Method method, unsigned number) {
  Sequence s{{}, {}, std::mt19937(number * 3u + static_cast<unsigned>(method))};
  const double width = 2 + 8 * s.unit(), height = 1 + 4 * s.unit();
  s.shape.outline = {Vec2(0, 0), Vec2(width, 0), Vec2(width, height), Vec2(0, height)};
  if (number % 3 == 1)
    for (Vec2& corner : s.shape.outline) corner += Vec2(0.4 * s.unit(), 0.4 * s.unit());
  s.shape.thickness = 0.05 + 0.3 * s.unit();
  if (number % 4 >= 2) {  // a window, a door that reaches the lower edge, or one that reaches beyond it
    const double x = width * 0.5 * s.unit(),
                 y = number % 4 == 2 ? 0.3 * height : -0.2 * static_cast<double>(number % 8 == 7);
    s.shape.openings.push_back(
        {Vec2(x, y), Vec2(x + 0.3 * width, y), Vec2(x + 0.3 * width, 0.7 * height), Vec2(x, 0.7 * height)});
  }
  if (number % 5 == 0) s.shape.held = {true, false, false, false};
  s.settings.method = method;
  s.settings.cell = 0.3 + 0.5 * s.unit();
  if (number % 2 == 0) s.settings.jitter = number % 6 == 0 ? 1.0 : s.unit();
  if (number % 6 == 4) s.settings.jitter = 0.0;
  s.settings.local.points = {3, 3 + static_cast<int>(12 * s.unit())};
  s.settings.local.length = {0.1 + 0.3 * s.unit(), 0.5 + s.unit()};
  s.settings.local.ring = 0.2 + 0.6 * s.unit();
  s.settings.seed = number;
  return s;
}

struct Hit {
  Vec2 at;
  std::optional<double> radius;
};

inline Hit random_hit(Sequence& s, const Hit& last) {
  const auto& corners = s.shape.outline;
  const auto i = static_cast<std::size_t>(4 * s.unit());
  const double share = s.unit();
  const Vec2 inside = corners[0] + s.unit() * (corners[1] - corners[0]) + s.unit() * (corners[3] - corners[0]);
  Hit hit{inside, std::nullopt};
  switch (static_cast<int>(10 * s.unit())) {
    case 0:
      hit.at = corners[i];
      break;  // on a corner
    case 1:
      hit.at = corners[i] + share * (corners[(i + 1) % 4] - corners[i]);
      break;  // on the border
    case 2:
      hit.at = Vec2(20 * s.unit() - 10, 20 * s.unit() - 10);
      break;  // perhaps outside
    case 3:
      hit.at = last.at;
      break;  // twice at one place
    case 4:
      hit.at = Vec2(std::round(inside.x()), std::round(inside.y()));
      break;  // where others may have been
    default:
      break;
  }
  switch (static_cast<int>(12 * s.unit())) {
    case 0:
      hit.radius = 0.0;
      break;
    case 1:
      hit.radius = 1e-9;
      break;
    case 2:
      hit.radius = s.unit() < 0.2 ? 1e9 : 0.5;
      break;
    case 3:
    case 4:
    case 5:
      hit.radius = s.unit();
      break;
    default:
      break;
  }
  if (s.unit() < 0.01) hit = {Vec2(1e9, -1e9), 1e9};
  return hit;
}

/// Everything that must hold after any hits; empty when it does. `chunk_area`: of all chunks so far.
inline std::string fault(const BreakablePanel& panel, double chunk_area) {
  if (!panel.valid()) return "the triangulation is not valid";
  const double whole = panel.intact_area(), error = std::abs(panel.area() + chunk_area - whole) / whole;
  if (!(error <= 1e-12)) return "areas do not add up: " + std::to_string(error * 1e12) + "e-12";
  const MeshAudit check = audit(panel.mesh());
  if (panel.area() > 0 ? !check.sound() : !panel.mesh().triangles.empty()) return "panel mesh: " + check.text();
  const double volume = panel.area() * panel.shape().thickness;
  if (!(std::abs(check.volume - volume) <= 1e-12 * whole * panel.shape().thickness))
    return "volume of the panel's mesh";
  return {};
}

inline std::string fault(const Chunk& chunk, double thickness) {
  const MeshAudit check = audit(mesh_of(chunk, thickness));
  if (!check.sound()) return "chunk mesh: " + check.text();
  const double volume = properties_of(chunk, thickness, 1).volume;
  if (!(std::abs(check.volume - volume) <= 1e-12 * volume + 1e-15)) return "volume of a chunk's mesh";
  return {};
}

/// What a run has met, to show that it tried something.
struct Tally {
  std::size_t chunks = 0;
  double area_error = 0;  ///< the largest, relative to the panel
};

/// Runs one sequence; says what went wrong first, or nothing.
inline std::string run_sequence(Method method, unsigned number, int hits, Tally* tally = nullptr) {
  Sequence s = random_sequence(method, number);
  BreakablePanel panel(s.shape, s.settings);
  double chunk_area = 0;
  Hit hit{Vec2(0.5, 0.5), std::nullopt};
  for (int k = 0; k < hits; ++k) {
    hit = random_hit(s, hit);
    const Fracture fracture = panel.hit(hit.at, hit.radius);
    std::string found;
    for (const Chunk& chunk : fracture.chunks) {
      chunk_area += area(chunk.outline);
      if (found.empty()) found = fault(chunk, s.shape.thickness);
    }
    if (found.empty()) found = fault(panel, chunk_area);
    if (tally) {
      tally->chunks += fracture.chunks.size();
      const double whole = panel.intact_area();
      tally->area_error = std::max(tally->area_error, std::abs(panel.area() + chunk_area - whole) / whole);
    }
    if (!found.empty()) return "sequence " + std::to_string(number) + ", hit " + std::to_string(k + 1) + ": " + found;
  }
  return {};
}

}  // namespace topple::fracture::test
