#include "topple/structure/member_shapes.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>

#include "model/index_of.h"

namespace topple::structure {
namespace {

/// Beside the line between its own ends, local axes.
struct Bow {
  std::array<Eigen::Vector3d, 2> turns{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};  ///< rad
  Eigen::Vector3d bulge = Eigen::Vector3d::Zero();                                         ///< m
};

/// s (1 - s) (a + b s) + 16 c s^2 (1 - s)^2 through what it deflects by at its quarters.
Bow bow_of(const StandingFrame& frame, MemberId id, double length) {
  Bow bow;
  const auto along = frame.internal_forces(id, 4);
  for (const int axis : {0, 1}) {
    const auto q = static_cast<std::size_t>(6 + axis);  // solver::BeamDiagram::deflection_y, deflection_z
    const double first = along[1][q], middle = along[2][q], last = along[3][q];
    const double mean = 32.0 / 3 * (first + last - 9.0 / 8 * middle), b = 32.0 / 3 * (last - first), a = mean - b / 2;
    // A slope along y is a turn about z; one along z a turn about y, backwards.
    const int about = axis == 0 ? 2 : 1;
    const double sense = axis == 0 ? 1 : -1;
    bow.turns[0][about] = sense * a / length;
    bow.turns[1][about] = -sense * (a + b) / length;
    bow.bulge[1 + axis] = middle - mean / 4;
  }
  return bow;
}

bool has_own_shape(const StandingFrame& frame, const Building& building, MemberId id) {
  for (int end = 0; end < 2; ++end) {
    const JointId joint = building.joint(id, end);
    if (!frame.intact(joint) || !(building[joint].stiffness.tail<3>().array() == unlimited).all()) return true;
  }
  return false;
}

}  // namespace

MemberShape shape_of_nodes(const Building& building, MemberId id, std::span<const Displacement> displacements) {
  const Member& member = building[id];
  MemberShape shape;
  for (std::size_t end = 0; end < 2; ++end) {
    Displacement& own = shape.ends[end] = displacements[index_of(member.nodes[end])];
    own.head<3>() += own.tail<3>().cross(Eigen::Vector3f(member.offsets[end].cast<float>()));
  }
  return shape;
}

MemberShape member_shape(const StandingFrame& frame, const Building& building, MemberId id,
                         std::span<const Displacement> displacements) {
  const Member& member = building[id];
  const Eigen::Vector3d axis = member.axes.row(0);
  const Bow bow = bow_of(frame, id, member.length);
  MemberShape shape = shape_of_nodes(building, id, displacements);
  const std::array<Eigen::Vector3d, 2> beside{member.axes.transpose() * bow.turns[0],
                                              member.axes.transpose() * bow.turns[1]};
  const auto moved = [&](std::size_t end) -> Eigen::Vector3d { return shape.ends[end].head<3>().cast<double>(); };
  const auto turned = [&](std::size_t end) -> Eigen::Vector3d { return shape.ends[end].tail<3>().cast<double>(); };
  Eigen::Vector3d chord = axis.cross(moved(1) - moved(0)) / member.length;
  // Where one joint holds alone, the member goes on from there as that end turns.
  for (const std::size_t held : {0U, 1U}) {
    const std::size_t loose = 1 - held;
    if (frame.intact(building.joint(id, static_cast<int>(loose)))) continue;
    const Eigen::Vector3d turn = turned(held);
    chord = turn - turn.dot(axis) * axis - beside[held];
    const Eigen::Vector3d way = (loose == 1 ? 1 : -1) * member.length * chord.cross(axis);
    shape.ends[loose].head<3>() = (moved(held) + way).cast<float>();
    shape.ends[loose].tail<3>() = shape.ends[held].tail<3>();
    break;
  }
  for (const std::size_t end : {0U, 1U})
    shape.ends[end].tail<3>() = (chord + beside[end] + turned(end).dot(axis) * axis).cast<float>();
  shape.bulge = (member.axes.transpose() * bow.bulge).cast<float>();
  return shape;
}

std::shared_ptr<const MemberShapes> read_member_shapes(const StandingFrame& frame, const Building& building,
                                                       const std::vector<bool>& yielded,
                                                       std::span<const Displacement> displacements) {
  auto shapes = std::make_shared<MemberShapes>();
  shapes->place.assign(building.members.size(), -1);
  const bool all = building.members.size() <= all_shapes_up_to;
  for (std::size_t i = 0; i < building.members.size(); ++i) {
    const MemberId id(i);
    if (!frame.stands(id) || !(all || yielded[i] || has_own_shape(frame, building, id))) continue;
    shapes->place[i] = static_cast<std::int32_t>(shapes->known.size());
    shapes->known.push_back(member_shape(frame, building, id, displacements));
  }
  return shapes;
}

void NearestMotion::add(const Eigen::Vector3d& at, const Displacement& moved) {
  points_.push_back({at, moved.head<3>().cast<double>(), moved.tail<3>().cast<double>()});
}

void NearestMotion::solve() {
  if (points_.empty()) return;
  const auto count = static_cast<double>(points_.size());
  for (const Point& one : points_) centre_ += one.at / count, moved_ += one.moved / count;
  double size = 0;  // m2, mean square of distances from the centre
  for (const Point& one : points_) size += (one.at - centre_).squaredNorm() / count;
  // Turns of the points count so little that they decide only what their places leave open: about a straight line.
  constexpr double little = 1e-6;
  const double weight = std::max(little * size, 1e-12);
  Eigen::Matrix3d sum = Eigen::Matrix3d::Identity() * weight * count;
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (const Point& one : points_) {
    const Eigen::Vector3d arm = one.at - centre_;
    sum += arm.squaredNorm() * Eigen::Matrix3d::Identity() - arm * arm.transpose();
    right += arm.cross(one.moved) + weight * one.turned;
  }
  turn_ = sum.ldlt().solve(right);
}

Displacement NearestMotion::beside(const Eigen::Vector3d& at, const Displacement& moved) const {
  Displacement left;
  left << (moved.head<3>().cast<double>() - moved_ - turn_.cross(at - centre_)).cast<float>(),
      (moved.tail<3>().cast<double>() - turn_).cast<float>();
  return left;
}

}  // namespace topple::structure
