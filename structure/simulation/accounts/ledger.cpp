#include <cmath>

#include "topple/structure/simulation.h"

namespace topple::structure {

double Ledger::residual() const {
  const double in = gravity_work + work_put_in;
  const double out = elastic + freed_by_breaks + dissipated_in_joints + kinetic_translation + kinetic_rotation +
                     lost_in_impacts + lost_in_contacts + removed + kinetic_standing + damped + lost_in_integration;
  const double scale = std::abs(gravity_work) + work_put_in;
  return scale > 0 ? (in - out) / scale : in - out;
}

}  // namespace topple::structure
