#include "topple/solver/geometric_forces.h"

#include <cmath>
#include <tuple>

namespace topple::solver {

Vec12 geometric_forces(const Beam& beam, double axial, const Vec12& rigid_ends) {
  Vec12 force = Vec12::Zero();
  if (axial == 0) return force;
  const double L = beam.length;
  // The local x-y plane has v' = rz, the x-z plane w' = -ry.
  for (const auto& [v, r, sense] : {std::tuple(1, 5, 1.0), std::tuple(2, 4, -1.0)}) {
    const double chord = (rigid_ends(v + 6) - rigid_ends(v)) / L;
    bool rigid = true, held = true;
    for (const Vec6& end : beam.end_stiffness) {
      rigid = rigid && std::isinf(end(v)) && std::isinf(end(r));
      held = held && end(0) > 0 && end(v) > 0;
    }
    if (!held) continue;
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

Vec12 geometric_forces(const Beam& beam, const Vec12& end_forces, const Vec6& first_node, const Vec6& second_node) {
  return geometric_forces(beam, (end_forces(6) - end_forces(0)) / 2,
                          rigid_end_displacements(beam, first_node, second_node));
}

}  // namespace topple::solver
