#pragma once
#include <Eigen/Core>
#include <limits>

namespace topple::solver {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
/// Six components, always in this order: x, y, z, rx, ry, rz.
using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;
using Vec12 = Eigen::Matrix<double, 12, 1>;
using Mat12 = Eigen::Matrix<double, 12, 12>;

/// Stiffness of a freedom that is held rigidly (a fixed support, a rigid member end).
inline constexpr double rigid = std::numeric_limits<double>::infinity();

}  // namespace topple::solver
