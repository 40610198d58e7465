#include "analysis/divided_member.h"

namespace topple::structure {

WholeMember whole_member(const Frame& frame, std::size_t member, const std::vector<solver::Beam>& beams,
                         const std::vector<solver::Vec12>& end_forces, std::vector<solver::BeamLoad> loads) {
  const std::vector<MemberPiece>& pieces = frame.pieces[member];
  WholeMember whole{beams[member], end_forces[member], std::move(loads)};
  if (pieces.empty()) return whole;
  const auto last = static_cast<std::size_t>(pieces.back().beam);
  whole.beam.node[1] = beams[last].node[1];
  whole.beam.offset[1] = beams[last].offset[1];
  whole.beam.end_stiffness[1] = beams[last].end_stiffness[1];
  whole.beam.length = pieces.back().start + beams[last].length;
  whole.end_forces.tail<6>() = end_forces[last].tail<6>();
  for (std::size_t i = 1; i < pieces.size(); ++i) {
    const auto before = static_cast<std::size_t>(pieces[i - 1].beam), after = static_cast<std::size_t>(pieces[i].beam);
    solver::BeamLoad tie;
    tie.beam = static_cast<int>(member);
    tie.kind = solver::BeamLoad::Kind::point;
    tie.from = pieces[i].start;
    tie.first = end_forces[before].tail<6>() + end_forces[after].head<6>();
    whole.loads.push_back(tie);
  }
  return whole;
}

}  // namespace topple::structure
