#include "standing/motion/motion_momentum.h"

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <map>

#include "model/point_inertia.h"
#include "standing/motion/rigid_displacement_fit.h"
#include "standing/motion/standing_motion.h"

namespace topple::structure {

/// Per kg that moves with the member: what changes of mass the frame has not taken over yet does not count.
Vec6 MotionMomentum::per_kilogram(MemberId member) const {
  const solver::FrameDynamics* frame = motion_.frame(from_.statics.component(member));
  if (frame == nullptr) return Vec6::Zero();
  const int number = from_.statics.number(member);
  const solver::Beam& beam = frame->model().beams[static_cast<std::size_t>(number)];
  const double mass = beam.density * beam.area * beam.length;
  return mass > 0 ? Vec6(frame->beam_momentum(number) / mass) : Vec6(Vec6::Zero());
}

Vec6 MotionMomentum::of(MemberId member) const { return masses_.own(member) * per_kilogram(member); }

namespace {

/// The places of a four-cornered plate that have its second moments, a quarter of its mass each (Gauss's two by two).
std::array<Vec3, 4> quarters(const std::array<Vec3, 4>& corner) {
  const double near = (1 + 1 / std::sqrt(3.0)) / 2, far = 1 - near;
  std::array<Vec3, 4> points;
  for (std::size_t i = 0; i < 4; ++i)
    points[i] = near * near * corner[i] + near * far * (corner[(i + 1) % 4] + corner[(i + 3) % 4]) +
                far * far * corner[(i + 2) % 4];
  return points;
}

}  // namespace

Vec6 MotionMomentum::of(PanelId panel) const {
  if (from_.building[panel].model == PanelModel::shell) {
    const solver::FrameDynamics* frame = motion_.frame(from_.components.of(panel));
    return frame == nullptr ? Vec6(Vec6::Zero()) : frame->patch_momentum(from_.statics.number(panel));
  }
  Vec6 sum = Vec6::Zero();
  const MotionMasses::Shares& shares = masses_.shares(panel);
  for (const auto& [member, mass] : shares.members) sum += mass * per_kilogram(member);
  for (const auto& [node, mass] : shares.nodes) sum.head<3>() += mass * motion_.velocity(node).head<3>();
  std::array<Vec3, 4> corner;
  for (std::size_t i = 0; i < 4; ++i) corner[i] = from_.building[from_.building[panel].nodes[i]].position;
  const std::array<Vec3, 4> mass_at = quarters(corner);
  Vec3 centre = Vec3::Zero();
  for (const Vec3& place : mass_at) centre += place;
  centre /= 4;
  Mat3 inertia = Mat3::Zero();
  for (const Vec3& place : mass_at) inertia += point_inertia(from_.loads.mass(panel) / 4, place - centre);
  const Vec3 linear = sum.head<3>();
  sum.tail<3>() = centre.cross(linear) + inertia * spin(panel);
  return sum;
}

Vec3 MotionMomentum::spin(PanelId panel) const {
  const Vec3 of_corners = spin_of_corners(panel);
  if (from_.building[panel].model == PanelModel::shell) return of_corners;
  RigidDisplacementFit motion;
  const MotionMasses::Shares& shares = masses_.shares(panel);
  for (const auto& [id, mass] : shares.members) {
    const Member& member = from_.building[id];
    const Vec3 way = from_.building[member.nodes[1]].position - from_.building[member.nodes[0]].position;
    motion.add_momentum(mass, middle(id), point_inertia(mass / 12, way), mass * per_kilogram(id));
  }
  for (const auto& [node, mass] : shares.nodes)
    motion.add_point(mass, from_.building[node].position, motion_.velocity(node).head<3>());
  return motion.turned(of_corners);
}

Vec3 MotionMomentum::spin_of_corners(PanelId panel) const {
  RigidDisplacementFit corners;
  int told = 0;
  for (const NodeId node : from_.building[panel].nodes) {
    if (from_.parts.segments.degree(node) == 0) continue;  // nothing tells how it moves
    corners.add_point(1, from_.building[node].position, motion_.velocity(node).head<3>());
    ++told;
  }
  return told < 3 ? Vec3(Vec3::Zero()) : corners.turned();
}

Vec3 MotionMomentum::velocity(PanelId panel) const {
  const Vec3 linear = of(panel).head<3>();
  double mass = 0;  // as the frame has it, whatever has broken out since its last substep
  for (const auto& [member, share] : masses_.shares(panel).members) mass += share;
  for (const auto& [node, share] : masses_.shares(panel).nodes) mass += share;
  if (from_.building[panel].model == PanelModel::shell) {
    const solver::FrameDynamics* frame = motion_.frame(from_.components.of(panel));
    if (frame == nullptr) return Vec3::Zero();
    const auto number = static_cast<std::size_t>(from_.statics.number(panel));
    const Eigen::MatrixXd& own = frame->model().patches[number].mass;
    mass = 0;
    for (Eigen::Index row = 2; row < own.rows(); row += 6)
      for (Eigen::Index column = 2; column < own.cols(); column += 6) mass += own(row, column);
  }
  return mass > 0 ? Vec3(linear / mass) : Vec3(Vec3::Zero());
}

Vec6 MotionMomentum::of(NodeId node) const {
  Vec6 sum = Vec6::Zero();
  const Vec3 given = from_.loads.mass(node) * motion_.velocity(node).head<3>();
  sum.head<3>() = given;
  sum.tail<3>() = from_.building[node].position.cross(given);
  return sum;
}

std::vector<std::pair<MemberId, Vec6>> MotionMomentum::brought(const MotionMasses::Rehung& panel) const {
  std::vector<std::pair<MemberId, Vec6>> to_members;
  std::map<MemberId, double> gained;
  for (const auto& [member, mass] : masses_.shares(panel.panel).members) gained[member] += mass;
  for (const auto& [member, mass] : panel.before.members) gained[member] -= mass;
  double lost = 0;
  Vec3 momentum = Vec3::Zero();
  for (const auto& [member, mass] : gained)
    if (mass < 0) {
      lost -= mass;
      momentum -= mass * per_kilogram(member).head<3>();
    }
  for (const auto& [node, mass] : panel.before.nodes) {
    lost += mass;
    momentum += mass * motion_.velocity(node).head<3>();
  }
  for (const auto& [node, mass] : masses_.shares(panel.panel).nodes) {
    lost -= mass;
    momentum -= mass * motion_.velocity(node).head<3>();
  }
  if (!(lost > 0)) return to_members;
  for (const auto& [id, mass] : gained) {
    if (!(mass > 0) || !includes(id)) continue;
    const Vec6 own = per_kilogram(id);
    Vec6 brought = -mass * own;
    brought.head<3>() += mass / lost * momentum;
    brought.tail<3>() += mass / lost * middle(id).cross(momentum);  // about the origin
    to_members.emplace_back(id, brought);
  }
  return to_members;
}

bool MotionMomentum::includes(MemberId member) const {
  return motion_.moves(from_.statics.component(member)) && from_.parts.stands(member);
}

Vec3 MotionMomentum::middle(MemberId id) const {
  const Member& member = from_.building[id];
  return (from_.building[member.nodes[0]].position + from_.building[member.nodes[1]].position) / 2;
}

Vec3 MotionMomentum::given_up(const MotionMasses::Rehung& panel) const {
  Vec3 momentum = Vec3::Zero();
  for (const auto& [member, mass] : panel.before.members) momentum += mass * per_kilogram(member).head<3>();
  for (const auto& [member, mass] : masses_.shares(panel.panel).members)
    momentum -= mass * per_kilogram(member).head<3>();
  return momentum;
}

std::vector<std::pair<MemberId, Vec6>> MotionMomentum::shared(const MotionMasses::Rehung& panel,
                                                              const Vec3& momentum) const {
  std::vector<std::pair<MemberId, Vec6>> to_members;
  for (const Shares* shares : {&masses_.shares(panel.panel).members, &panel.before.members}) {
    double whole = 0;
    for (const auto& [member, mass] : *shares)
      if (includes(member)) whole += mass;
    if (!(whole > 0)) continue;
    for (const auto& [member, mass] : *shares) {
      if (!includes(member)) continue;
      const Vec3 own = mass / whole * momentum;
      Vec6& given = to_members.emplace_back(member, Vec6::Zero()).second;
      given << own, middle(member).cross(own);
    }
    return to_members;
  }
  return to_members;
}

}  // namespace topple::structure
