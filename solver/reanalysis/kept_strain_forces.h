#pragma once
// The end forces of each beam by unit strains: computed when they are first needed, and kept until the beam changes.
#include <vector>

#include "assembly/frame_system.h"
#include "elements/beam_strain_forces.h"

namespace topple::solver {

class KeptStrainForces {
 public:
  explicit KeptStrainForces(std::size_t beams) : forces_(beams), known_(beams, 0) {}
  /// The beam changed.
  void forget(std::size_t beam) { known_[beam] = 0; }
  [[nodiscard]] const BeamStrainForces& of(const FrameSystem& system, std::size_t beam) const {
    if (known_[beam] == 0) {
      forces_[beam] = BeamStrainForces(CondensedBeam(system.model.beams[beam], system.beam_factor[beam]));
      known_[beam] = 1;
    }
    return forces_[beam];
  }

 private:
  mutable std::vector<BeamStrainForces> forces_;
  mutable std::vector<char> known_;
};

}  // namespace topple::solver
