#include "simulation/impact/push_impulses.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/QR>
#include <cmath>

namespace topple::structure {

namespace {

using Vec6 = CoupledPush::Vec6;
using Ways = Eigen::Matrix<double, 6, Eigen::Dynamic>;

/// Shares of the columns that make up as much of `change` as lies in them.
Eigen::VectorXd shares_of(const Ways& ways, const Vec6& change) {
  // Of the largest: normals of contacts are known no better, and impulses that cancel out stay below 1e5 of what is
  // left of them, so that momentum is kept to 1e-10.
  constexpr double dependent = 1e-5;
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> parts;
  parts.setThreshold(dependent);
  parts.compute(ways);
  return parts.solve(change);
}

}  // namespace

PushImpulses impulses_of_push(const PushingBody& body, std::span<const PushedPlace> places, const Vec6& rates_out,
                              const std::vector<char>& through) {
  const Eigen::SelfAdjointEigenSolver<Mat3> axes(body.inertia);
  const Mat3 root = axes.operatorSqrt(), inverse_root = axes.operatorInverseSqrt();
  const double mass_root = std::sqrt(body.mass);
  const auto n = static_cast<Eigen::Index>(places.size());
  // Scaled by the roots of the masses, squares of lengths are energies.
  Ways ways(6, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const PushedPlace& place = places[static_cast<std::size_t>(i)];
    ways.col(i) << place.normal / mass_root, inverse_root * (place.point - body.centre).cross(place.normal);
  }
  Vec6 wanted;
  wanted << mass_root * (rates_out.head<3>() - body.velocity), root * (rates_out.tail<3>() - body.spin);
  PushImpulses result;
  result.along = shares_of(ways, wanted);
  const Vec6 change = ways * result.along;
  std::vector<Eigen::Index> faster;
  for (Eigen::Index i = 0; i < n; ++i)
    if (through[static_cast<std::size_t>(i)] != 0 && ways.col(i).dot(change) > 0) faster.push_back(i);
  if (!faster.empty()) {
    const Eigen::VectorXd less = shares_of(ways(Eigen::all, faster), change);
    for (std::size_t k = 0; k < faster.size(); ++k) result.along(faster[k]) -= less(static_cast<Eigen::Index>(k));
  }
  const Vec6 given = ways * result.along;
  result.change << given.head<3>() / mass_root, inverse_root * given.tail<3>();
  return result;
}

}  // namespace topple::structure
