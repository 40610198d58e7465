#include <cmath>

#include "topple/structure/collapse_report.h"

namespace topple::structure {

double Ledger::residual() const {
  const double in = gravity_work + work_put_in;
  const double out = elastic + freed_by_breaks + dissipated_in_joints + kinetic_translation + kinetic_rotation +
                     lost_in_impacts + lost_in_contacts + removed + kinetic_standing + damped + lost_in_integration;
  const double scale = std::abs(gravity_work) + work_put_in;
  return scale > 0 ? (in - out) / scale : in - out;
}

std::vector<std::pair<const char*, double>> ledger_entries(const Ledger& ledger) {
  return {{"gravity_work", ledger.gravity_work},
          {"work_put_in", ledger.work_put_in},
          {"elastic", ledger.elastic},
          {"freed_by_breaks", ledger.freed_by_breaks},
          {"dissipated_in_joints", ledger.dissipated_in_joints},
          {"kinetic_translation", ledger.kinetic_translation},
          {"kinetic_rotation", ledger.kinetic_rotation},
          {"lost_in_impacts", ledger.lost_in_impacts},
          {"lost_in_contacts", ledger.lost_in_contacts},
          {"removed", ledger.removed},
          {"kinetic_standing", ledger.kinetic_standing},
          {"damped", ledger.damped},
          {"lost_in_integration", ledger.lost_in_integration},
          {"residual", ledger.residual()}};
}

}  // namespace topple::structure
