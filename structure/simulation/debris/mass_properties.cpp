#include "simulation/debris/mass_properties.h"

#include <cmath>

#include "model/point_inertia.h"

namespace topple::structure {

namespace {

/// Area, first and second moments of a polygon in its plane.
struct AreaMoments {
  double area = 0;
  Vec2 first = Vec2::Zero();
  Eigen::Matrix2d second = Eigen::Matrix2d::Zero();  ///< integrals of x x, x y, y y about the origin

  /// Green's theorem over the edges, counted with its own sign.
  void add(const std::vector<Vec2>& polygon, double sign) {
    AreaMoments own;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Vec2 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
      const double cross = a.x() * b.y() - b.x() * a.y();
      own.area += cross / 2;
      own.first += cross / 6 * (a + b);
      const Vec2 sum = a + b;
      own.second += cross / 24 * (a * a.transpose() + b * b.transpose() + sum * sum.transpose());
    }
    const double orientation = own.area < 0 ? -sign : sign;
    area += orientation * own.area;
    first += orientation * own.first;
    second += orientation * own.second;
  }
};

AreaMoments outline_moments(const Building& building, const Panel& panel) {
  const Vec3 origin = building[panel.nodes[0]].position;
  std::vector<Vec2> outline;
  for (const NodeId node : panel.nodes) outline.push_back((panel.axes * (building[node].position - origin)).head<2>());
  AreaMoments moments;
  moments.add(outline, 1);
  for (const auto& opening : panel.openings) moments.add(opening, -1);
  return moments;
}

}  // namespace

void MassProperties::add(const MassProperties& other) {
  if (other.mass == 0) return;
  const double total = mass + other.mass;
  const Vec3 joint_centre = (mass * centre + other.mass * other.centre) / total;
  inertia += other.inertia + point_inertia(mass, centre - joint_centre) +
             point_inertia(other.mass, other.centre - joint_centre);
  mass = total;
  centre = joint_centre;
}

LineMass line_mass(const Member& member, const std::vector<solver::BeamLoad>& loads, double gravity) {
  const Vec3 down = -member.axes.col(2);  // global -z in the member's axes
  LineMass line;
  for (const solver::BeamLoad& load : loads) {
    if (load.kind == solver::BeamLoad::Kind::temperature) continue;
    const double a = load.first.head<3>().dot(down) / gravity, b = load.last.head<3>().dot(down) / gravity;
    const double s = load.from;
    if (load.kind == solver::BeamLoad::Kind::point) {
      line.mass += a;
      line.first_moment += a * s;
      line.second_moment += a * s * s;
      continue;
    }
    // intensity a + (b - a) t / e over t in [0, e]; moments about s + t
    const double e = load.to - load.from;
    const double m0 = e * (a + b) / 2, m1 = e * e * (a + 2 * b) / 6, m2 = e * e * e * (a + 3 * b) / 12;
    line.mass += m0;
    line.first_moment += s * m0 + m1;
    line.second_moment += s * s * m0 + 2 * s * m1 + m2;
  }
  return line;
}

MassProperties member_mass(const Building& building, const Member& member, const LineMass& line) {
  const Section& section = building[member.section];
  const double centre = line.first_moment / line.mass;
  const double along = line.second_moment - line.mass * centre * centre;
  const double about_y = line.mass * section.Iy / section.area, about_z = line.mass * section.Iz / section.area;
  MassProperties properties;
  properties.mass = line.mass;
  properties.centre = member_start(building, member) + centre * member.axes.row(0).transpose();
  const Vec3 principal(about_y + about_z, along + about_y, along + about_z);
  properties.inertia = member.axes.transpose() * principal.asDiagonal() * member.axes;
  return properties;
}

MassProperties panel_mass(const Building& building, const Panel& panel, double mass) {
  const AreaMoments moments = outline_moments(building, panel);
  const double per_area = mass / moments.area;
  const Vec2 centre = moments.first / moments.area;
  const Eigen::Matrix2d second = per_area * (moments.second - moments.area * centre * centre.transpose());
  const double across = mass * panel.thickness * panel.thickness / 12;
  Mat3 inertia = Mat3::Zero();
  inertia(0, 0) = second(1, 1) + across;
  inertia(1, 1) = second(0, 0) + across;
  inertia(0, 1) = inertia(1, 0) = -second(0, 1);
  inertia(2, 2) = second(0, 0) + second(1, 1);
  MassProperties properties;
  properties.mass = mass;
  properties.centre = building[panel.nodes[0]].position + panel.axes.transpose() * Vec3(centre.x(), centre.y(), 0);
  properties.inertia = panel.axes.transpose() * inertia * panel.axes;
  return properties;
}

MassProperties point_mass(const Vec3& at, double mass) { return {mass, at, Mat3::Zero()}; }

MassProperties sphere_mass(const Vec3& at, double mass, double radius) {
  return {mass, at, 0.4 * mass * radius * radius * Mat3::Identity()};
}

double member_volume(const Building& building, const Member& member) {
  return building[member.section].area * member.length;
}

double panel_volume(const Building& building, const Panel& panel) {
  return outline_moments(building, panel).area * panel.thickness;
}

}  // namespace topple::structure
