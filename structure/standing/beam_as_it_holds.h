#pragma once
// A standing member's beam with its broken ends released, whether the statics know of the breaks yet or not.
#include "standing/standing_parts.h"
#include "standing/statics/frame_statics.h"

namespace topple::structure {

[[nodiscard]] inline solver::Beam beam_as_it_holds(const FrameStatics& statics, const StandingParts& parts,
                                                   MemberId member) {
  solver::Beam beam = statics.beam(member);
  for (int end = 0; end < 2; ++end)
    if (!parts.holds(parts.building().joint(member, end))) beam.end_stiffness[static_cast<std::size_t>(end)].setZero();
  return beam;
}

}  // namespace topple::structure
