#include "formats/geometry.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace topple::structure::formats {

namespace {

constexpr double smallest_angle = 1e-6;  // rad, between `up` and the axis; and the slope that counts as vertical

double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

double signed_area(const std::vector<Vec2>& polygon) {
  double twice = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) twice += cross(polygon[i], polygon[(i + 1) % polygon.size()]);
  return twice / 2;
}

/// Segments a-b and c-d have a point in common.
bool meet(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  const auto side = [](const Vec2& p, const Vec2& q, const Vec2& r) { return cross(q - p, r - p); };
  const auto between = [](const Vec2& p, const Vec2& q, const Vec2& r) {
    return r.x() >= std::min(p.x(), q.x()) && r.x() <= std::max(p.x(), q.x()) && r.y() >= std::min(p.y(), q.y()) &&
           r.y() <= std::max(p.y(), q.y());
  };
  const double s1 = side(a, b, c), s2 = side(a, b, d), s3 = side(c, d, a), s4 = side(c, d, b);
  if (((s1 > 0 && s2 < 0) || (s1 < 0 && s2 > 0)) && ((s3 > 0 && s4 < 0) || (s3 < 0 && s4 > 0))) return true;
  return (s1 == 0 && between(a, b, c)) || (s2 == 0 && between(a, b, d)) || (s3 == 0 && between(c, d, a)) ||
         (s4 == 0 && between(c, d, b));
}

bool crosses_itself(const std::vector<Vec2>& polygon) {
  const std::size_t n = polygon.size();
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i + 2; j < n; ++j)
      if ((j + 1) % n != i && meet(polygon[i], polygon[i + 1], polygon[j], polygon[(j + 1) % n])) return true;
  return false;
}

}  // namespace

std::optional<Mat3> member_axes(const Vec3& along, const std::optional<Vec3>& up, double roll) {
  const Vec3 x = along.stableNormalized();
  const bool vertical = x.head<2>().norm() < smallest_angle;
  const Vec3 towards = (up ? *up : (vertical ? Vec3::UnitX() : Vec3::UnitZ())).stableNormalized();
  const Vec3 across = towards.cross(x);
  if (!(across.norm() >= smallest_angle)) return std::nullopt;
  const Vec3 y0 = across.normalized(), z0 = x.cross(y0);
  Mat3 axes;
  axes.row(0) = x;
  if (roll == 0) {
    axes.row(1) = y0;
    axes.row(2) = z0;
  } else {
    axes.row(1) = std::cos(roll) * y0 + std::sin(roll) * z0;
    axes.row(2) = std::cos(roll) * z0 - std::sin(roll) * y0;
  }
  return axes;
}

PanelGeometry panel_geometry(const std::array<Vec3, 4>& p) {
  PanelGeometry result;
  const Vec3 first = p[2] - p[0], second = p[3] - p[1];
  const double longer = std::max(first.norm(), second.norm());
  const Vec3 normal = first.cross(second);
  const Vec3 z = normal.stableNormalized();
  if (!(normal.norm() > 1e-9 * longer * longer)) return result;
  result.warp = std::abs((p[1] - p[0]).dot(z)) / longer;
  const Vec3 edge = p[1] - p[0];
  const Vec3 x = (edge - edge.dot(z) * z).stableNormalized();
  result.axes.row(0) = x;
  result.axes.row(1) = z.cross(x);
  result.axes.row(2) = z;
  result.convex = true;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3 before = p[(i + 1) % 4] - p[i], after = p[(i + 2) % 4] - p[(i + 1) % 4];
    if (!(before.cross(after).dot(z) > 1e-9 * longer * longer)) result.convex = false;
  }
  return result;
}

std::string opening_fault(const std::vector<Vec2>& opening, const std::array<Vec2, 4>& outline) {
  if (opening.size() < 3) return "an opening of fewer than 3 points; accepted: a polygon";
  const double size = std::max((outline[2] - outline[0]).norm(), (outline[3] - outline[1]).norm());
  if (std::abs(signed_area(opening)) <= 1e-9 * size * size) return "an opening without area; accepted: a polygon";
  if (crosses_itself(opening)) return "an opening whose sides meet; accepted: a polygon that does not cross itself";
  for (const Vec2& point : opening)
    for (std::size_t i = 0; i < 4; ++i) {
      const Vec2 side = outline[(i + 1) % 4] - outline[i];
      if (cross(side, point - outline[i]) < -1e-9 * size * side.norm())
        return "an opening that leaves the panel; accepted: points within its outline, in its local x and y from node "
               "1";
    }
  return {};
}

}  // namespace topple::structure::formats
