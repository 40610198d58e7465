#include "elements/beam_mass.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>

namespace topple::solver {
namespace {

struct PerLength {
  double mass, about_y, about_z, spin;
};

PerLength per_length(const Beam& beam, const MassModel& masses, double length) {
  const double polar = masses.torsional == TorsionalMass::polar ? beam.Iy + beam.Iz : beam.J;
  const double density = beam.density * (beam.length / length);
  const double rotary = masses.rotary_inertia ? density : 0;
  return {density * beam.area, rotary * beam.Iy, rotary * beam.Iz, density * polar};
}

Mat12 lumped(const PerLength& m, double length) {
  Vec12 diagonal;
  for (const int end : {0, 6}) {
    diagonal.segment<3>(end).setConstant(m.mass);
    diagonal.segment<3>(end + 3) << m.spin, m.about_y, m.about_z;
  }
  return (length / 2 * diagonal).asDiagonal();
}

/// Freedoms v1, r1, v2, r2 with v' = r.
Eigen::Matrix4d bending(double mass, double rotary, double L) {
  const double t = mass * L / 420, r = rotary / (30 * L);
  Eigen::Matrix4d translation, rotation;
  translation << 156, 22 * L, 54, -13 * L, 22 * L, 4 * L * L, 13 * L, -3 * L * L, 54, 13 * L, 156, -22 * L, -13 * L,
      -3 * L * L, -22 * L, 4 * L * L;
  rotation << 36, 3 * L, -36, 3 * L, 3 * L, 4 * L * L, -3 * L, -L * L, -36, -3 * L, 36, -3 * L, 3 * L, -L * L, -3 * L,
      4 * L * L;
  return t * translation + r * rotation;
}

void put_along(Mat12& M, int freedom, double total) {
  M(freedom, freedom) = M(freedom + 6, freedom + 6) = total / 3;
  M(freedom, freedom + 6) = M(freedom + 6, freedom) = total / 6;
}

Mat12 between_ends(const PerLength& m, double length) {
  Mat12 M = Mat12::Zero();
  put_along(M, 0, m.mass * length);
  put_along(M, 3, m.spin * length);
  constexpr std::array<int, 4> xy{1, 5, 7, 11}, xz{2, 4, 8, 10};
  const Eigen::Matrix4d in_xy = bending(m.mass, m.about_z, length), in_xz = bending(m.mass, m.about_y, length);
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < 4; ++j) {
      const auto ii = static_cast<Eigen::Index>(i), jj = static_cast<Eigen::Index>(j);
      M(xy[i], xy[j]) = in_xy(ii, jj);
      M(xz[i], xz[j]) = (i % 2 == j % 2 ? 1 : -1) * in_xz(ii, jj);  // w' = -r
    }
  return M;
}

}  // namespace

// (K + k) ends = k rigid ends in the freedoms that are not rigid. What the releases leave loose (a spin) stays at rest.
Mat12 ends_by_rigid_ends(const Beam& beam) {
  std::vector<int> soft;
  Vec12 spring;
  for (int f = 0; f < 12; ++f) {
    spring(f) = beam.end_stiffness[static_cast<std::size_t>(f / 6)](f % 6);
    if (!std::isinf(spring(f))) soft.push_back(f);
  }
  Mat12 result = Mat12::Identity();
  if (soft.empty()) return result;
  Beam rigid_ends = beam;
  for (Vec6& end : rigid_ends.end_stiffness) end.setConstant(std::numeric_limits<double>::infinity());
  const Mat12 K = CondensedBeam(rigid_ends, 1).stiffness();
  const auto n = static_cast<Eigen::Index>(soft.size());
  Eigen::MatrixXd own(n, n), from_rigid_ends = Eigen::MatrixXd::Zero(n, 12);
  Eigen::VectorXd scale(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const int f = soft[static_cast<std::size_t>(i)];
    for (Eigen::Index j = 0; j < n; ++j) own(i, j) = K(f, soft[static_cast<std::size_t>(j)]);
    own(i, i) += spring(f);
    scale(i) = 1 / std::sqrt(own(i, i));
    for (int g = 0; g < 12; ++g)
      if (std::isinf(spring(g))) from_rigid_ends(i, g) = -K(f, g);
    from_rigid_ends(i, f) = spring(f);
  }
  const Eigen::MatrixXd scaled = scale.asDiagonal() * own * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> modes(scaled);
  constexpr double loose = 1e-12;
  Eigen::VectorXd inverse = modes.eigenvalues();
  for (double& value : inverse) value = value > loose ? 1 / value : 0;
  const Eigen::MatrixXd ends = scale.asDiagonal() * modes.eigenvectors() * inverse.asDiagonal() *
                               modes.eigenvectors().transpose() * scale.asDiagonal() * from_rigid_ends;
  for (Eigen::Index i = 0; i < n; ++i) result.row(soft[static_cast<std::size_t>(i)]) = ends.row(i);
  return result;
}

Mat12 mass_between_ends(const Beam& beam, const MassModel& masses, double length) {
  return between_ends(per_length(beam, masses, length), length);
}

Mat12 beam_mass_matrix(const Beam& beam, const MassModel& masses, double length) {
  const PerLength m = per_length(beam, masses, length);
  if (masses.distribution == MassDistribution::lumped) return lumped(m, length);
  const Mat12 follow = ends_by_rigid_ends(beam);
  return follow.transpose() * between_ends(m, length) * follow;
}

}  // namespace topple::solver
