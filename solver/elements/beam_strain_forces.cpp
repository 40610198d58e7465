#include "elements/beam_strain_forces.h"

namespace topple::solver {

BeamStrainForces::BeamStrainForces(const CondensedBeam& beam) {
  const BeamStrainStiffness K = strain_stiffness(beam);
  for (int end = 0; end < 2; ++end) {
    axial_[static_cast<std::size_t>(end)] = K(6 * end, 0);
    torsion_[static_cast<std::size_t>(end)] = K(6 * end + 3, 3);
  }
  for (std::size_t k = 0; k < 4; ++k) {
    xy_[k] = {K(in_xy[k], 1), K(in_xy[k], 5)};
    xz_[k] = {K(in_xz[k], 2), K(in_xz[k], 4)};
  }
}

}  // namespace topple::solver
