#pragma once
// A member as the solver's beam: geometry, material and section, without nodes, ends and mass.
#include "topple/solver/frame_model.h"
#include "topple/structure/building.h"

namespace topple::structure {

[[nodiscard]] inline solver::Beam elastic_beam(const Building& building, MemberId id) {
  const Member& member = building[id];
  const Section& section = building[member.section];
  const Material& material = building[member.material];
  solver::Beam beam;
  beam.offset = member.offsets;
  beam.axes = member.axes;
  beam.length = member.length;
  beam.youngs_modulus = material.youngs_modulus;
  beam.shear_modulus = material.shear_modulus;
  beam.area = section.area;
  beam.shear_area_y = section.shear_area_y;
  beam.shear_area_z = section.shear_area_z;
  beam.Iy = section.Iy;
  beam.Iz = section.Iz;
  beam.J = section.J;
  return beam;
}

}  // namespace topple::structure
