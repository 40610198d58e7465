#include "simulation/impact/free_panel_edges.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include "failure/panel_demand.h"

namespace topple::structure {

namespace {

using Mat6 = Eigen::Matrix<double, 6, 6>;

/// Cross product as a matrix.
Mat3 across(const Vec3& v) {
  Mat3 matrix;
  matrix << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return matrix;
}

}  // namespace

std::array<Vec6, 4> free_panel_edge_demands(const Building& building, PanelId id, const std::array<double, 4>& length,
                                            std::span<const PanelPush> pushes) {
  const Panel& panel = building[id];
  const auto corner = [&](std::size_t i) -> const Vec3& { return building[panel.nodes[i % 4]].position; };
  const Vec3 middle = (corner(0) + corner(1) + corner(2) + corner(3)) / 4;
  std::array<Vec6, 4> demands{Vec6::Zero(), Vec6::Zero(), Vec6::Zero(), Vec6::Zero()};
  // Of an edge that turns about its middle, per length and angle: across it by its length, about itself by the
  // thickness.
  const auto turning = [&](std::size_t edge) -> Mat3 {
    const Vec3 way = corner(edge + 1) - corner(edge), along = way.normalized();
    return way.squaredNorm() / 12 * (Mat3::Identity() - along * along.transpose()) +
           panel.thickness * panel.thickness / 12 * (along * along.transpose());
  };
  const auto arm = [&](std::size_t edge) -> Vec3 { return (corner(edge) + corner(edge + 1)) / 2 - middle; };
  Mat6 stiffness = Mat6::Zero();
  double held = 0;
  for (std::size_t edge = 0; edge < 4; ++edge) {
    if (!(length[edge] > 0)) continue;
    const Mat3 lever = across(arm(edge));
    held += length[edge];
    stiffness.topLeftCorner<3, 3>() += length[edge] * Mat3::Identity();
    stiffness.topRightCorner<3, 3>() -= length[edge] * lever;
    stiffness.bottomLeftCorner<3, 3>() += length[edge] * lever;
    stiffness.bottomRightCorner<3, 3>() += length[edge] * (turning(edge) - lever * lever);
  }
  if (!(held > 0)) return demands;
  Vec6 load = Vec6::Zero();
  for (const PanelPush& push : pushes) {
    load.head<3>() += push.force;
    load.tail<3>() += (push.point - middle).cross(push.force);
  }
  const Vec6 moves = stiffness.ldlt().solve(-load);
  for (std::size_t edge = 0; edge < 4; ++edge) {
    if (!(length[edge] > 0)) continue;
    const Mat3 axes = edge_axes(building, panel, edge);
    const Vec3 force = moves.head<3>() + Vec3(moves.tail<3>()).cross(arm(edge));
    demands[edge] << axes * force, axes * (turning(edge) * moves.tail<3>());
  }
  return demands;
}

}  // namespace topple::structure
