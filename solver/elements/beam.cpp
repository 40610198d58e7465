#include "elements/beam.h"

#include <Eigen/Geometry>
#include <cmath>
#include <stdexcept>
#include <string>

#include "elements/beam_internal_forces.h"

namespace topple::solver {
namespace {

constexpr std::array<int, 4> xy_freedoms{1, 5, 7, 11};  ///< v1, rz1, v2, rz2
constexpr std::array<int, 4> xz_freedoms{2, 4, 8, 10};  ///< w1, ry1, w2, ry2

template <std::size_t N>
std::array<double, N> springs(const Beam& beam, const std::array<int, N>& freedoms) {
  std::array<double, N> result{};
  for (std::size_t k = 0; k < N; ++k) {
    result[k] = beam.end_stiffness[static_cast<std::size_t>(freedoms[k] / 6)](freedoms[k] % 6);
  }
  return result;
}

double shear_flexibility(double length, double shear_stiffness) {
  return shear_stiffness > 0 ? length / shear_stiffness : 0;
}

void scatter_plane(const std::array<int, 4>& freedoms, const Eigen::Matrix4d& plane, Mat12& K) {
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      K(freedoms[static_cast<std::size_t>(i)], freedoms[static_cast<std::size_t>(j)]) = plane(i, j);
    }
  }
}

void scatter_axis(int freedom, double k, Mat12& K) {
  K(freedom, freedom) = K(freedom + 6, freedom + 6) = k;
  K(freedom, freedom + 6) = K(freedom + 6, freedom) = -k;
}

bool all_released(const Beam& beam) {
  return (beam.end_stiffness[0].array() == 0).all() && (beam.end_stiffness[1].array() == 0).all();
}

[[noreturn]] void refuse(int index, const std::string& what) {
  throw std::invalid_argument("beam " + std::to_string(index) + ": " + what);
}

}  // namespace

void check_beam(const Beam& beam, int index, int node_count) {
  for (int node : beam.node) {
    if (node < 0 || node >= node_count) refuse(index, "node " + std::to_string(node) + " does not exist");
  }
  const std::array<std::pair<double, const char*>, 7> positive{{{beam.length, "length"},
                                                                {beam.youngs_modulus, "Young's modulus"},
                                                                {beam.shear_modulus, "shear modulus"},
                                                                {beam.area, "area"},
                                                                {beam.Iy, "Iy"},
                                                                {beam.Iz, "Iz"},
                                                                {beam.J, "J"}}};
  for (const auto& [value, name] : positive) {
    if (!(value > 0) || !std::isfinite(value)) refuse(index, std::string(name) + " must be finite and above 0");
  }
  if (!(beam.shear_area_y >= 0 && beam.shear_area_z >= 0)) refuse(index, "shear areas must not be negative");
  for (const Vec6& end : beam.end_stiffness) {
    if (!(end.array() >= 0).all()) refuse(index, "end stiffness must be 0, a positive spring or rigid");
  }
  if (beam.axial != AxialAction::both)
    refuse(index, "tension-only and compression-only members are not supported here");
}

CondensedBeam::CondensedBeam(const Beam& beam, double factor)
    : beam_(beam),
      factor_(factor),
      axial_(beam.length / (factor * beam.youngs_modulus * beam.area), springs(beam, std::array<int, 2>{0, 6})),
      torsion_(beam.length / (factor * beam.shear_modulus * beam.J), springs(beam, std::array<int, 2>{3, 9})),
      in_xy_(beam.length, factor * beam.youngs_modulus * beam.Iz,
             shear_flexibility(beam.length, factor * beam.shear_modulus * beam.shear_area_y), 1,
             springs(beam, xy_freedoms)),
      in_xz_(beam.length, factor * beam.youngs_modulus * beam.Iy,
             shear_flexibility(beam.length, factor * beam.shear_modulus * beam.shear_area_z), -1,
             springs(beam, xz_freedoms)),
      absent_(all_released(beam)) {}

Mat12 CondensedBeam::stiffness() const {
  Mat12 K = Mat12::Zero();
  scatter_axis(0, axial_.stiffness(), K);
  scatter_axis(3, torsion_.stiffness(), K);
  scatter_plane(xy_freedoms, in_xy_.stiffness(), K);
  scatter_plane(xz_freedoms, in_xz_.stiffness(), K);
  return K;
}

FixedEndForces CondensedBeam::fixed_end_forces(std::span<const BeamLoad> loads) const {
  FixedEndForces result;
  if (loads.empty() || absent_) return result;
  static thread_local InternalForces forces;  // a joint that breaks asks for no memory
  find_internal_forces(beam_.length, Vec6::Zero(), loads, forces);
  const Vec6 tip = integrate_deformation(beam_, factor_, forces);
  const Vec6& statics = forces.second_end;
  const auto axial = axial_.fixed_end_forces(statics(0), -tip(0), result.unbalanced);
  const auto torsion = torsion_.fixed_end_forces(statics(3), -tip(3), result.unbalanced);
  const Eigen::Vector4d xy = in_xy_.fixed_end_forces({statics(1), statics(5)}, {tip(1), tip(5)}, result.unbalanced);
  const Eigen::Vector4d xz = in_xz_.fixed_end_forces({statics(2), statics(4)}, {tip(2), tip(4)}, result.unbalanced);
  for (int end = 0; end < 2; ++end) {
    result.force(6 * end) = axial[static_cast<std::size_t>(end)];
    result.force(6 * end + 3) = torsion[static_cast<std::size_t>(end)];
  }
  for (std::size_t k = 0; k < 4; ++k) {
    result.force(xy_freedoms[k]) = xy(static_cast<Eigen::Index>(k));
    result.force(xz_freedoms[k]) = xz(static_cast<Eigen::Index>(k));
  }
  // What cannot be carried is a mechanism only beyond the rounding of a balanced load.
  constexpr double rounding = 1e-10;
  const double scale = statics.cwiseAbs().sum() * (1 + 1 / beam_.length);
  if (result.unbalanced <= rounding * scale) result.unbalanced = 0;
  for (const BeamLoad& load : loads) {
    if (load.kind != BeamLoad::Kind::temperature || (load.first.isZero(0) && load.last.isZero(0))) continue;
    const Mat12 K = stiffness();
    result.force -= K.leftCols<6>() * load.first + K.rightCols<6>() * load.last;
  }
  return result;
}

Vec6 relative_motion(double length, const Vec12& rigid_end_displacements) {
  Vec6 strain = rigid_end_displacements.tail<6>() - rigid_end_displacements.head<6>();
  strain(1) -= length * rigid_end_displacements(5);
  strain(2) += length * rigid_end_displacements(4);
  return strain;
}

BeamStrainStiffness strain_stiffness(const CondensedBeam& beam) { return beam.stiffness().rightCols<6>(); }

// Only what the second end moves beyond the rigid motion of the first strains the beam: taking it first keeps the
// digits that a large sway of the whole frame would cost.
Vec12 beam_end_forces(const CondensedBeam& beam, double length, const Vec12& rigid_end_displacements,
                      const Vec12& fixed_end) {
  return strain_stiffness(beam) * relative_motion(length, rigid_end_displacements) + fixed_end;
}

Mat3 arm_matrix(const Vec3& arm) {
  Mat3 m;
  m << 0, arm.z(), -arm.y(), -arm.z(), 0, arm.x(), arm.y(), -arm.x(), 0;
  return m;
}

Vec12 rigid_end_displacements(const Beam& beam, const Vec6& first_node, const Vec6& second_node) {
  Vec12 result;
  for (int end = 0; end < 2; ++end) {
    const Vec6& u = end == 0 ? first_node : second_node;
    const Vec3 rotation = u.tail<3>();
    const Vec3 translation = u.head<3>() + rotation.cross(beam.offset[static_cast<std::size_t>(end)]);
    result.segment<3>(6 * end) = beam.axes * translation;
    result.segment<3>(6 * end + 3) = beam.axes * rotation;
  }
  return result;
}

Vec12 node_forces(const Beam& beam, const Vec12& end_forces) {
  Vec12 result;
  for (int end = 0; end < 2; ++end) {
    const Vec3 force = beam.axes.transpose() * end_forces.segment<3>(6 * end);
    const Vec3 moment = beam.axes.transpose() * end_forces.segment<3>(6 * end + 3);
    result.segment<3>(6 * end) = force;
    result.segment<3>(6 * end + 3) = moment + beam.offset[static_cast<std::size_t>(end)].cross(force);
  }
  return result;
}

Mat12 to_node_freedoms(const Mat3& axes, const Mat12& local, const std::array<Mat3, 2>& arm) {
  Mat12 K;
  for (int i = 0; i < 4; ++i) {
    for (int j = i; j < 4; ++j) {
      const Mat3 block = axes.transpose() * (local.block<3, 3>(3 * i, 3 * j) * axes);
      K.block<3, 3>(3 * i, 3 * j) = block;
      if (i != j) K.block<3, 3>(3 * j, 3 * i) = block.transpose();
    }
  }
  for (int end = 0; end < 2; ++end) {
    const Mat3& C = arm[static_cast<std::size_t>(end)];
    if ((C.array() == 0).all()) continue;
    const int t = 6 * end, r = t + 3;
    K.middleRows<3>(r) += C.transpose() * K.middleRows<3>(t);
    K.middleCols<3>(r) += K.middleCols<3>(t) * C;
  }
  return K;
}

}  // namespace topple::solver
