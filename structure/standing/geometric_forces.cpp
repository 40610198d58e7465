#include "standing/geometric_forces.h"

#include <Eigen/Geometry>
#include <cmath>

namespace topple::structure {

solver::Vec12 geometric_forces(const solver::Beam& beam, double axial, const solver::Vec12& rigid_ends) {
  solver::Vec12 force = solver::Vec12::Zero();
  if (axial == 0) return force;
  const double L = beam.length;
  // The local x-y plane has v' = rz, the x-z plane w' = -ry.
  for (const auto& [v, r, sense] : {std::tuple(1, 5, 1.0), std::tuple(2, 4, -1.0)}) {
    const double chord = (rigid_ends(v + 6) - rigid_ends(v)) / L;
    bool rigid = true;
    for (const solver::Vec6& end : beam.end_stiffness) rigid = rigid && std::isinf(end(v)) && std::isinf(end(r));
    if (!rigid) {
      force(v + 6) += axial * chord;
      force(v) -= axial * chord;
      continue;
    }
    const double first = sense * rigid_ends(r), second = sense * rigid_ends(r + 6);
    const double shear = axial * (1.2 * chord - 0.1 * (first + second));
    force(v) -= shear;
    force(v + 6) += shear;
    force(r) += sense * axial * L * (-0.1 * chord + 2.0 / 15 * first - second / 30);
    force(r + 6) += sense * axial * L * (-0.1 * chord - first / 30 + 2.0 / 15 * second);
  }
  return force;
}

solver::Vec12 rigid_ends_of(const solver::Beam& beam, const solver::Vec6& first, const solver::Vec6& second) {
  solver::Vec12 rigid_ends;
  rigid_ends << beam.axes * (first.head<3>() + first.tail<3>().cross(beam.offset[0])), beam.axes * first.tail<3>(),
      beam.axes * (second.head<3>() + second.tail<3>().cross(beam.offset[1])), beam.axes * second.tail<3>();
  return rigid_ends;
}

solver::Vec12 forces_at_nodes(const solver::Beam& beam, const solver::Vec12& end_forces) {
  solver::Vec12 result;
  for (int end = 0; end < 2; ++end) {
    const solver::Vec3 force = beam.axes.transpose() * end_forces.segment<3>(6 * end);
    const solver::Vec3 moment = beam.axes.transpose() * end_forces.segment<3>(6 * end + 3);
    result.segment<3>(6 * end) = force;
    result.segment<3>(6 * end + 3) = moment + beam.offset[static_cast<std::size_t>(end)].cross(force);
  }
  return result;
}

}  // namespace topple::structure
