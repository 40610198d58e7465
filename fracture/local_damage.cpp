#include "topple/fracture/local_damage.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "cross.h"
#include "random.h"

namespace topple::fracture {

namespace {

/// Corners farther away than this multiple of the farthest distance are drawn in to it: seen from the panel they lie at
/// infinity, and their coordinates would lose the panel's digits.
constexpr double kFarthest = 1e4;

std::vector<double> draw_angles(int count, Random& random) {
  constexpr double turn = 2 * std::numbers::pi;
  for (;;) {
    std::vector<double> angles;
    for (int i = 0; i < count; ++i) angles.push_back((i + random.between(-0.5, 0.5)) / count * turn);
    double gap = angles.front() + turn - angles.back();
    for (std::size_t i = 1; i < angles.size(); ++i) gap = std::max(gap, angles[i] - angles[i - 1]);
    if (gap < std::numbers::pi) return angles;
  }
}

/// The hit, the multiples of the ring on the way to a corner where there is anything to be cut, the corner.
std::vector<Vec2> marks(const Vec2& hit, const Vec2& corner, double ring, double nearest, double farthest) {
  const double length = (corner - hit).norm();
  std::vector<Vec2> points{hit};
  for (double k = std::max(1.0, std::floor(nearest / ring)); k * ring < length * (1 - 1e-6) && k * ring < farthest; ++k)
    points.push_back(hit + k * ring / length * (corner - hit));
  points.push_back(corner);
  return points;
}

/// The sector between two corners, cut across at the marks of both radii.
void add_sector(const std::vector<Vec2>& right, const std::vector<Vec2>& left, std::vector<Polygon>& cells) {
  cells.push_back({right[0], right[1], left[1]});
  const std::size_t both = std::min(right.size(), left.size());
  for (std::size_t k = 1; k + 1 < both; ++k) cells.push_back({right[k], right[k + 1], left[k + 1], left[k]});
  // What is longer on one side is cut off towards the other side's corner.
  for (std::size_t k = both - 1; k + 1 < right.size(); ++k) cells.push_back({right[k], right[k + 1], left.back()});
  for (std::size_t k = both - 1; k + 1 < left.size(); ++k) cells.push_back({left[k], right.back(), left[k + 1]});
}

/// Closes concave corners by triangles, going back one edge after each.
Polygon close_corners(Polygon outline, std::vector<Polygon>& triangles) {
  std::size_t steady = 0;
  for (std::size_t i = 0; outline.size() > 3 && steady < outline.size();) {
    const std::size_t n = outline.size();
    const Vec2 &before = outline[(i + n - 1) % n], &corner = outline[i % n], &after = outline[(i + 1) % n];
    if (cross(corner - before, after - corner) >= 0) {
      ++steady;
      i = (i + 1) % n;
      continue;
    }
    triangles.push_back({before, after, corner});
    outline.erase(outline.begin() + static_cast<std::ptrdiff_t>(i));
    steady = 0;
    i = (i + n - 2) % (n - 1);
  }
  return outline;
}

}  // namespace

void check(const LocalDamageSettings& settings) {
  if (!(settings.points[0] >= 3 && settings.points[1] >= settings.points[0] && settings.points[1] <= 1000))
    throw std::invalid_argument("points must be two numbers from 3 to 1000, the least first");
  if (!(settings.length[0] > 0 && settings.length[1] >= settings.length[0] && std::isfinite(settings.length[1])))
    throw std::invalid_argument("length must be two lengths above 0, the least first");
  if (!(settings.ring > 0)) throw std::invalid_argument("ring must be above 0");
}

LocalDamage local_damage(const Vec2& hit, double scale, const LocalDamageSettings& settings, std::uint64_t seed,
                         double nearest, double farthest) {
  check(settings);
  Random random(seed);
  const int choices = settings.points[1] - settings.points[0] + 1;
  const int count = settings.points[0] + std::min(choices - 1, static_cast<int>(choices * random.unit()));
  LocalDamage damage;
  for (const double angle : draw_angles(count, random)) {
    const double length = random.between(settings.length[0], settings.length[1]) * scale;
    damage.corners.push_back(hit + std::min(length, kFarthest * farthest) * Vec2(std::cos(angle), std::sin(angle)));
  }
  std::vector<std::vector<Vec2>> radii;
  for (const Vec2& corner : damage.corners) radii.push_back(marks(hit, corner, settings.ring, nearest, farthest));
  for (std::size_t i = 0; i < radii.size(); ++i) add_sector(radii[i], radii[(i + 1) % radii.size()], damage.cells);
  damage.outline = close_corners(damage.corners, damage.cells);
  return damage;
}

}  // namespace topple::fracture
