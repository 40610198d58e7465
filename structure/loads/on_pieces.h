#pragma once
#include <vector>

#include "topple/structure/frame.h"

namespace topple::structure {

/// Lays a load of a whole member on its pieces, which must not be none: adds what each of them has to `out`, with the
/// piece's beam and distances from the piece's first end.
void lay_on_pieces(const solver::FrameModel& model, const std::vector<MemberPiece>& pieces,
                   const solver::BeamLoad& load, std::vector<solver::BeamLoad>& out);

}  // namespace topple::structure
